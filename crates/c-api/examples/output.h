#ifndef OUTPUT_H
#define OUTPUT_H

#include <stdint.h>

/* Writes a name, a decimal number and 16 hexadecimal digits. */
void write_line(const char *name, uint32_t index, uint64_t bits);

/* The replay; 0 if all went well. */
int replay(void);

#endif
