/* Limits of a gate, and vectors held within them, however large. */
#ifndef DRAKE_HAPTICS_LIMITS_H_
#define DRAKE_HAPTICS_LIMITS_H_

#include <float.h>
#include <math.h>

#include "wire.h"

/* Limits of a gate. A maximum of zero shows nothing: use it for the torque of a
 * device that has none. */
typedef struct dh_gate_limits {
  double max_force_N;             /* largest norm of the force, >= 0 */
  double max_torque_Nm;           /* largest norm of the torque, >= 0 */
  double max_speed_m_per_s;       /* speed of the handle while active, > 0 */
  double max_turn_rate_rad_per_s; /* its turn rate while active, > 0 */
  double ramp_in_s;               /* time from zero to full, 0.001 to 10 */
  double ramp_out_s;              /* time from full to zero, 0.001 to 1 */
  double max_ttl_s;               /* longest life of a command, 1e-6 to 1 */
} dh_gate_limits;

/* Defaults for a device of this strength: ramp in over 200 ms, ramp out within
 * 20 ms, handle below 2 m/s and 30 rad/s, commands live at most 100 ms. */
static inline dh_gate_limits dh_gate_default_limits(double max_force_N,
                                                    double max_torque_Nm) {
  dh_gate_limits limits;
  limits.max_force_N = max_force_N;
  limits.max_torque_Nm = max_torque_Nm;
  limits.max_speed_m_per_s = 2.0;
  limits.max_turn_rate_rad_per_s = 30.0;
  limits.ramp_in_s = 0.2;
  limits.ramp_out_s = 0.02;
  limits.max_ttl_s = 0.1;
  return limits;
}

static inline int dh_is_within(double x, double low, double high) {
  return dh_is_finite(x) && x >= low && x <= high;
}

/* Returns what is wrong with the limits, or NULL. */
static inline const char* dh_limits_problem(const dh_gate_limits* limits) {
  if (!dh_is_within(limits->max_force_N, 0, FLT_MAX)) {
    return "max_force_N must be finite and at least 0";
  }
  if (!dh_is_within(limits->max_torque_Nm, 0, FLT_MAX)) {
    return "max_torque_Nm must be finite and at least 0";
  }
  if (!dh_is_within(limits->max_speed_m_per_s, DBL_MIN, DBL_MAX)) {
    return "max_speed_m_per_s must be finite and above 0";
  }
  if (!dh_is_within(limits->max_turn_rate_rad_per_s, DBL_MIN, DBL_MAX)) {
    return "max_turn_rate_rad_per_s must be finite and above 0";
  }
  if (!dh_is_within(limits->ramp_in_s, 0.001, 10)) {
    return "ramp_in_s must be from 0.001 to 10";
  }
  if (!dh_is_within(limits->ramp_out_s, 0.001, 1)) {
    return "ramp_out_s must be from 0.001 to 1";
  }
  if (!dh_is_within(limits->max_ttl_s, 1e-6, 1)) {
    return "max_ttl_s must be from 1e-6 to 1";
  }
  return NULL;
}

static inline int dh_are_finite(const double* values, int count) {
  int i;
  for (i = 0; i < count; ++i) {
    if (!dh_is_finite(values[i])) return 0;
  }
  return 1;
}

/* Splits the norm of a finite vector into largest * norm, so that 1e308 cannot
 * overflow: divides v by its largest component, which it returns. */
static inline double dh_split_norm(const double v[3], double unit[3],
                                   double* norm) {
  double largest = 0;
  int i;
  for (i = 0; i < 3; ++i) {
    const double size = v[i] < 0 ? -v[i] : v[i];
    if (size > largest) largest = size;
  }
  for (i = 0; i < 3; ++i) unit[i] = largest > 0 ? v[i] / largest : 0;
  *norm = sqrt(unit[0] * unit[0] + unit[1] * unit[1] + unit[2] * unit[2]);
  return largest;
}

static inline int dh_exceeds(const double v[3], double limit) {
  double unit[3], norm;
  const double largest = dh_split_norm(v, unit, &norm);
  return largest > 0 && largest > limit / norm;
}

/* Shortens a finite vector to the limit if it is longer. */
static inline void dh_clamp_norm(const double v[3], double limit,
                                 double out[3]) {
  double unit[3], norm;
  const double largest = dh_split_norm(v, unit, &norm);
  /* Four round-offs less, so that the norm of the result never exceeds the
   * limit, however it is computed. */
  const double allowed = limit * (1 - 4 * DBL_EPSILON);
  int i;
  for (i = 0; i < 3; ++i) {
    out[i] = largest > 0 && largest > allowed / norm
                 ? unit[i] * (allowed / norm)
                 : v[i];
  }
}

#endif /* DRAKE_HAPTICS_LIMITS_H_ */
