/* The replay on a Cortex-M4F: vectors, start-up and text over semihosting, without a C library.
 * memory.x is that of examples/controller/board. */
#include "output.h"

#include <stddef.h>

extern uint32_t _stack_top, _data_start, _data_end, _data_load, _bss_start, _bss_end;

#define CPACR (*(volatile uint32_t *)0xE000ED88U)
#define WRITE_CHARACTER 0x03U
#define EXIT_EXTENDED 0x20U
#define APPLICATION_EXIT 0x20026U

static void semihosting(uint32_t operation, const void *parameter)
{
    register uint32_t r0 __asm__("r0") = operation;
    register const void *r1 __asm__("r1") = parameter;
    __asm__ volatile("bkpt #0xab" : "+r"(r0) : "r"(r1) : "memory");
}

static void write_character(uint32_t character)
{
    semihosting(WRITE_CHARACTER, &character);
}

static void write_digits(uint64_t number, uint32_t base, uint32_t least)
{
    char digits[20];
    uint32_t count = 0;
    while (number > 0 || count < least) {
        digits[count++] = "0123456789abcdef"[number % base];
        number /= base;
    }
    while (count > 0) {
        write_character((uint32_t)digits[--count]);
    }
}

void write_line(const char *name, uint32_t index, uint64_t bits)
{
    while (*name != '\0') {
        write_character((uint32_t)*name++);
    }
    write_character(' ');
    write_digits(index, 10, 1);
    write_character(' ');
    for (int place = 60; place >= 0; place -= 4) {
        write_digits((bits >> place) & 15U, 16, 1);
    }
    write_character('\n');
}

static void leave(uint32_t status)
{
    uint32_t block[2] = {APPLICATION_EXIT, status};
    semihosting(EXIT_EXTENDED, block);
    for (;;) {
    }
}

static void start(void)
{
    const uint32_t *from = &_data_load;
    for (uint32_t *to = &_data_start; to < &_data_end; to++) {
        *to = *from++;
    }
    for (uint32_t *to = &_bss_start; to < &_bss_end; to++) {
        *to = 0;
    }
    leave((uint32_t)replay());
}

__attribute__((naked, noreturn)) void _reset(void)
{
    /* The floating-point unit first: the compiler may use its registers anywhere else. */
    __asm__ volatile("ldr r0, =0xE000ED88\n"
                     "ldr r1, [r0]\n"
                     "orr r1, r1, #(0xf << 20)\n"
                     "str r1, [r0]\n"
                     "dsb\n"
                     "isb\n"
                     "b %c0\n"
                     :
                     : "i"(start));
}

static void exception(void)
{
    leave(70);
}

__attribute__((section(".vectors"), used)) static void *const vectors[16] = {
    &_stack_top, (void *)_reset,    (void *)exception, (void *)exception,
    (void *)exception, (void *)exception, (void *)exception, (void *)exception,
    (void *)exception, (void *)exception, (void *)exception, (void *)exception,
    (void *)exception, (void *)exception, (void *)exception, (void *)exception,
};

/* Functions that the compiler may call. */
void *memcpy(void *to, const void *from, size_t count)
{
    unsigned char *target = to;
    const unsigned char *source = from;
    while (count-- > 0) {
        *target++ = *source++;
    }
    return to;
}

void *memset(void *to, int value, size_t count)
{
    unsigned char *target = to;
    while (count-- > 0) {
        *target++ = (unsigned char)value;
    }
    return to;
}
