/* Replays a record as a controller would, saves and restores half-way, and prints the bits of all
 * results: the program of the host and of the target, compared with the Rust filter.
 *
 * record.h, which `cargo figures embedded --part controller` makes, has RECORD_ROWS and RECORD_G. */
#include "gyrocal.h"
#include "output.h"
#include "record.h"

#define RADIANS_PER_DEGREE 0.017453292519943295
#define INTERVAL_S 60.0f

static GyrocalFilter filter;

static uint32_t bits_of(float number)
{
    union {
        float number;
        uint32_t bits;
    } both = {.number = number};
    return both.bits;
}

static uint64_t digest = 0xcbf29ce484222325U;

static void add(float number)
{
    uint32_t bits = bits_of(number);
    for (int byte = 0; byte < 4; byte++) {
        digest = (digest ^ ((bits >> (8 * byte)) & 0xffU)) * 0x100000001b3U;
    }
}

/* The 19 numbers: coefficients, sigmas, NIS. */
static int32_t results(float numbers[19])
{
    int32_t status = gyrocal_drift(&filter, numbers);
    if (status == GYROCAL_OK) {
        status = gyrocal_sigma(&filter, numbers + 9);
    }
    if (status == GYROCAL_OK) {
        status = gyrocal_nis(&filter, numbers + 18);
    }
    return status;
}

/* A reset of the controller: the state survives in memory that keeps it. */
static int32_t reset(const GyrocalSettings *settings)
{
    static uint8_t kept[GYROCAL_SAVED_SIZE];
    int32_t status = gyrocal_save(&filter, kept, sizeof kept);
    const GyrocalFilter nothing = {{0}};
    filter = nothing;
    if (status == GYROCAL_OK && gyrocal_coast(&filter, INTERVAL_S) != GYROCAL_NOT_RUNNING) {
        status = GYROCAL_FAILED;
    }
    if (status == GYROCAL_OK) {
        status = gyrocal_init(&filter, settings);
    }
    kept[100] ^= 1;
    if (status == GYROCAL_OK
        && gyrocal_restore(&filter, kept, sizeof kept) != GYROCAL_SAVED_CHECKSUM) {
        status = GYROCAL_FAILED;
    }
    kept[100] ^= 1;
    return status == GYROCAL_OK ? gyrocal_restore(&filter, kept, sizeof kept) : status;
}

/* Settings without meaning are refused, and a wild sample is passed over. */
static int32_t refusals(const GyrocalSettings *settings)
{
    const float nothing = 0.0f, infinite = 1.0f / nothing, no_number = infinite - infinite;
    GyrocalSettings bad[] = {*settings, *settings, *settings, *settings, *settings, *settings};
    bad[0].latitude_rad = 1e30f;
    bad[1].latitude_rad = no_number;
    bad[2].gravity_g = 0.0f;
    bad[3].earth_rate_rad_per_s = infinite;
    bad[4].angles_rad[1] = no_number;
    bad[5].largest_nis = 0.0f;
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        if (gyrocal_init(&filter, &bad[i]) != GYROCAL_SETTINGS) {
            return GYROCAL_FAILED;
        }
    }
    const float wild[3] = {0.02f, 0.02f, 0.99f};
    uint32_t count = 0;
    int32_t status = gyrocal_init(&filter, settings);
    if (status == GYROCAL_OK && gyrocal_update(&filter, wild) != GYROCAL_SAMPLE_SURPRISING) {
        status = GYROCAL_FAILED;
    }
    for (int minute = 1; minute <= 60 && status == GYROCAL_OK; minute++) {
        int32_t expected = minute < 60 ? GYROCAL_SAMPLE_SURPRISING : GYROCAL_DIVERGED;
        if (gyrocal_step(&filter, INTERVAL_S, wild) != expected) {
            status = GYROCAL_FAILED;
        }
    }
    if (status == GYROCAL_OK) {
        status = gyrocal_surprising_samples(&filter, &count);
    }
    if (status == GYROCAL_OK && count != 61) {
        status = GYROCAL_FAILED;
    }
    return status == GYROCAL_OK ? gyrocal_reopen(&filter, RECORD_G[60]) : status;
}

int replay(void)
{
    GyrocalSettings settings;
    float numbers[19];
    const float angles_deg[3] = {12.0f, -25.0f, 40.0f};
    int32_t status = gyrocal_default_settings(&settings, (float)(48.2 * RADIANS_PER_DEGREE));
    for (int axis = 0; axis < 3; axis++) {
        settings.angles_rad[axis] = (float)((double)angles_deg[axis] * RADIANS_PER_DEGREE);
    }
    if (status == GYROCAL_OK) {
        status = refusals(&settings);
    }
    if (status == GYROCAL_OK) {
        status = gyrocal_init(&filter, &settings);
    }
    if (status == GYROCAL_OK) {
        status = gyrocal_update(&filter, RECORD_G[0]);
    }
    for (uint32_t row = 1; row < RECORD_ROWS && status == GYROCAL_OK; row++) {
        if (row == RECORD_ROWS / 2) {
            status = reset(&settings);
        }
        if (status == GYROCAL_OK) {
            status = gyrocal_step(&filter, INTERVAL_S, RECORD_G[row]);
        }
        if (status == GYROCAL_OK) {
            status = results(numbers);
        }
        for (int i = 0; i < 19 && status == GYROCAL_OK; i++) {
            add(numbers[i]);
        }
        if (row % 720 == 0) {
            write_line("digest", row, digest);
        }
    }
    if (status != GYROCAL_OK) {
        write_line("status", 0, (uint64_t)(int64_t)status);
        return 1;
    }
    for (uint32_t i = 0; i < 19; i++) {
        write_line("number", i, bits_of(numbers[i]));
    }
    return 0;
}
