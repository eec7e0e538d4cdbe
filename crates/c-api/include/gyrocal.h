/* Streaming filter of the drift coefficients of a stabilised platform, single precision.
 *
 * The filter lives in memory of the caller: a variable of type GyrocalFilter, whose contents are
 * private. Nothing allocates, blocks, panics or keeps a pointer. Each function that returns int32_t
 * returns a status: GYROCAL_OK, a refusal (nothing has changed), or a failure (the filter has
 * stopped; initialise or restore it). A filter is used from one thread at a time. */

#ifndef GYROCAL_H
#define GYROCAL_H

/* Made by cbindgen from crates/c-api; do not edit. `cargo figures embedded --part controller` checks it. */

#include <stddef.h>
#include <stdint.h>

// Words of 32 bits that a filter takes.
#define GYROCAL_FILTER_WORDS 602

// Bytes that a filter takes.
#define GYROCAL_FILTER_SIZE 2408

// Alignment of a filter in bytes.
#define GYROCAL_FILTER_ALIGNMENT 4

// Bytes of a saved state.
#define GYROCAL_SAVED_SIZE 476

// Number of drift coefficients: bias, g and g² term of gyro x, then of y and z.
#define GYROCAL_COEFFICIENTS 9

// The call did as it was told.
#define GYROCAL_OK 0

// Refused: a component of the sample is infinite or no number.
#define GYROCAL_SAMPLE_NOT_FINITE 1

// Refused: a component of the sample is beyond the range of the sensor.
#define GYROCAL_SAMPLE_OUT_OF_RANGE 2

// Refused: the interval is zero, negative or no number.
#define GYROCAL_INTERVAL_NOT_POSITIVE 3

// Refused: the interval is longer than the limit.
#define GYROCAL_INTERVAL_TOO_LONG 4

// Refused: a saved state has another length.
#define GYROCAL_SAVED_LENGTH 5

// Refused: a saved state is of another version, model or number type.
#define GYROCAL_SAVED_VERSION 6

// Refused: the checksum of a saved state is wrong.
#define GYROCAL_SAVED_CHECKSUM 7

// Refused: a number of a saved state has no meaning, such as a variance that is not positive.
#define GYROCAL_SAVED_NUMBERS 8

// Refused: a pointer is null.
#define GYROCAL_NULL 9

// The memory holds no filter, or the filter has stopped: initialise or restore it.
#define GYROCAL_NOT_RUNNING -1

// A setting has no meaning: the filter is not running.
#define GYROCAL_SETTINGS -2

// The step failed, and the filter has stopped: initialise or restore it.
#define GYROCAL_FAILED -3

// A filter. Its contents are private; memory of zeros is no filter, and is answered as such.
typedef struct {
  uint32_t words[602];
} GyrocalFilter;

// Settings of a filter. gyrocal_default_settings fills them.
typedef struct {
  // Astronomic latitude, rad, north positive.
  float latitude_rad;
  // Sidereal rotation rate of the Earth, rad/s.
  float earth_rate_rad_per_s;
  // Local gravity in the unit of the samples.
  float gravity_g;
  // Prior means of the coefficients: deg/h, deg/h/g, deg/h/g².
  float drift[9];
  // Their standard deviations.
  float drift_sigma[9];
  // Platform angles against East, North, Up at the first sample, about x, then y, then z, rad.
  float angles_rad[3];
  // Their standard deviations, rad.
  float angles_sigma_rad[3];
  // Standard deviation of one sample, g.
  float accel_noise_g;
  // Standard deviation of the white drift noise held over one minute, deg/h.
  float drift_noise_deg_per_h;
  // Longest interval that is integrated in one step, s; longer ones are divided.
  float longest_step_s;
  // Explicit Euler instead of Runge-Kutta if not 0.
  uint32_t euler;
  // Largest reading of an accelerometer, g.
  float largest_force_g;
  // Longest interval of a call, s.
  float longest_interval_s;
} GyrocalSettings;

#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

// Initialises a filter at its first sample, which gyrocal_update takes. What the memory held
// before is forgotten, so this is also the reset.
//
// # Safety
// Each pointer must be null or point to what its type says.
int32_t gyrocal_init(GyrocalFilter *filter, const GyrocalSettings *settings);

// Takes a sample of three accelerometers in g at the time the filter is at: the first one.
//
// # Safety
// Each pointer must be null or point to what its type says, `sample` to three numbers.
int32_t gyrocal_update(GyrocalFilter *filter, const float *sample);

// Time passes, and at its end a sample of three accelerometers in g is taken.
//
// # Safety
// As gyrocal_update.
int32_t gyrocal_step(GyrocalFilter *filter, float interval_s, const float *sample);

// Time passes without a sample.
//
// # Safety
// `filter` must be null or point to a filter.
int32_t gyrocal_coast(GyrocalFilter *filter, float interval_s);

// Writes the nine drift coefficients: deg/h, deg/h/g, deg/h/g² of gyro x, then of y and z.
//
// # Safety
// `filter` must be null or point to a filter, `drift` to nine numbers.
int32_t gyrocal_drift(const GyrocalFilter *filter, float *drift);

// Writes the standard deviations of the errors of the nine drift coefficients.
//
// # Safety
// As gyrocal_drift.
int32_t gyrocal_sigma(const GyrocalFilter *filter, float *sigma);

// Writes the normalised innovation squared of the last sample; three is expected.
//
// # Safety
// As gyrocal_drift, `nis` to one number.
int32_t gyrocal_nis(const GyrocalFilter *filter, float *nis);

// Writes the state with version and checksum to GYROCAL_SAVED_SIZE bytes.
//
// # Safety
// `filter` must be null or point to a filter, `place` to as many bytes as `length` says.
int32_t gyrocal_save(const GyrocalFilter *filter, uint8_t *place, size_t length);

// Takes over a saved state. The filter must have been initialised with the settings of the one
// that was saved; a filter that has stopped runs again.
//
// # Safety
// `filter` must be null or point to a filter, `saved` to as many bytes as `length` says.
int32_t gyrocal_restore(GyrocalFilter *filter, const uint8_t *saved, size_t length);

// Fills the settings of a platform that is aligned with East, North, Up to 0.01 deg at a latitude
// in rad: coefficients of zero known to 1 deg/h (per g, per g²), noise of 1e-5 g and 0.002 deg/h,
// samples to 2 g, intervals to an hour.
//
// # Safety
// `settings` must be null or point to settings.
int32_t gyrocal_default_settings(GyrocalSettings *settings, float latitude_rad);

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

#endif  /* GYROCAL_H */
