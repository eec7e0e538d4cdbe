/* Streaming filter of the drift coefficients of a stabilised platform, single precision.
 *
 * The filter lives in memory of the caller: a variable of type GyrocalFilter, whose contents are
 * private. Nothing allocates, blocks, panics or keeps a pointer. Each function that returns int32_t
 * returns a status: GYROCAL_OK, a refusal (nothing has changed), a sample that was not taken though its
 * time has passed (GYROCAL_SAMPLE_SURPRISING and above), or a failure (the filter has stopped; initialise
 * or restore it). A filter is used from one thread at a time. */

#ifndef GYROCAL_H
#define GYROCAL_H

/* Made by cbindgen from crates/c-api; do not edit. `cargo figures embedded --part controller` checks it. */

#include <stddef.h>
#include <stdint.h>

// Words of 32 bits that a filter takes.
#define GYROCAL_FILTER_WORDS 656

// Bytes that a filter takes.
#define GYROCAL_FILTER_SIZE 2624

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

// The NIS of the sample is beyond the limit. It was not taken; the time of the call has passed without it,
// so it needs no gyrocal_coast.
#define GYROCAL_SAMPLE_SURPRISING 10

// As GYROCAL_SAMPLE_SURPRISING, and so were all samples of the last hour, ten at least: it is the filter
// that is wrong. gyrocal_reopen takes the sample all the same.
#define GYROCAL_DIVERGED 11

// No sample was taken since gyrocal_init, and the attitude has become too uncertain meanwhile for a first
// one: initialise again at a sample. The time of the call has passed.
#define GYROCAL_GAP_AT_START 12

// The memory holds no filter, or the filter has stopped: initialise or restore it.
#define GYROCAL_NOT_RUNNING -1

// A setting is outside its domain: the filter is not running.
#define GYROCAL_SETTINGS -2

// The step failed, and the filter has stopped: initialise or restore it.
#define GYROCAL_FAILED -3

// A filter. Its contents are private; memory of zeros is no filter, and is answered as such.
typedef struct {
  uint32_t words[656];
} GyrocalFilter;

// Settings of a filter. gyrocal_default_settings fills them. gyrocal_init refuses a number outside its
// domain, and anything that is no number.
typedef struct {
  // Astronomic latitude, rad, north positive; from -pi/2 to pi/2.
  float latitude_rad;
  // Sidereal rotation rate of the Earth, rad/s; finite.
  float earth_rate_rad_per_s;
  // Local gravity in the unit of the samples; positive, finite.
  float gravity_g;
  // Prior means of the coefficients: deg/h, deg/h/g, deg/h/g²; finite.
  float drift[9];
  // Their standard deviations; positive, as is the square.
  float drift_sigma[9];
  // Platform angles against East, North, Up at the first sample, about x, then y, then z, rad;
  // finite.
  float angles_rad[3];
  // Their standard deviations, rad; positive, as is the square.
  float angles_sigma_rad[3];
  // Standard deviation of one sample, g; positive, as is the square.
  float accel_noise_g;
  // Standard deviation of the white drift noise held over one minute, deg/h; positive,
  // as is the square.
  float drift_noise_deg_per_h;
  // Longest interval that is integrated in one step, s; longer ones are divided. Positive; may be
  // infinite.
  float longest_step_s;
  // Explicit Euler instead of Runge-Kutta if not 0.
  uint32_t euler;
  // Largest reading of an accelerometer, g; positive, may be infinite.
  float largest_force_g;
  // Longest interval of a call, s; positive, may be infinite.
  float longest_interval_s;
  // Largest normalised innovation squared of a sample that is taken; positive, and infinite to take all.
  float largest_nis;
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

// Takes a sample at the time the filter is at, whatever its NIS: after GYROCAL_DIVERGED, with the sample
// that was answered so. All sigmas are widened in the same proportion until it is no surprise.
//
// # Safety
// As gyrocal_update.
int32_t gyrocal_reopen(GyrocalFilter *filter,
                       const float *sample);

// Writes the number of samples since gyrocal_init that were not taken because of their NIS.
//
// # Safety
// `filter` must be null or point to a filter, `count` to a number.
int32_t gyrocal_surprising_samples(const GyrocalFilter *filter, uint32_t *count);

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
// samples to 2 g, intervals to an hour, a NIS to 34.08: a sound record exceeds it once in ten years at
// one sample a minute.
//
// # Safety
// `settings` must be null or point to settings.
int32_t gyrocal_default_settings(GyrocalSettings *settings,
                                 float latitude_rad);

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

#endif  /* GYROCAL_H */
