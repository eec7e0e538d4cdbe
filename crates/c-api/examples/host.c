/* The replay on a host. */
#include "output.h"

#include <inttypes.h>
#include <stdio.h>

void write_line(const char *name, uint32_t index, uint64_t bits)
{
    printf("%s %" PRIu32 " %016" PRIx64 "\n", name, index, bits);
}

int main(void)
{
    return replay();
}
