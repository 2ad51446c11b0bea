/* The gate: what stands between commands from anywhere and a hand.
 *
 * It runs in the driver, beside the hardware, and decides which command is
 * obeyed and what wrench is shown. A pure state machine: no clock, no socket,
 * no allocation; time is an argument, the work of a call is bounded, and force
 * and torque never exceed the limits in any state. docs/device-protocol.md has
 * its diagram. In each tick a driver calls, in this order:
 *
 *   dh_gate_receive()  for each packet that came, up to some bound
 *   dh_gate_fail()     if its own hardware is at fault
 *   dh_gate_step()     once, and shows that wrench
 *
 * C99, and C++ as well. Needs sqrt() of the C library (-lm). */
#ifndef DRAKE_HAPTICS_GATE_H_
#define DRAKE_HAPTICS_GATE_H_

#include <float.h>
#include <math.h>

#include "wire.h"

enum { DH_REMEMBERED_SESSIONS = 8 };

/* What a gate allows. A maximum of zero shows nothing, as for the torque of a
 * device that has none. */
typedef struct dh_gate_limits {
  double max_force_N;             /* of the norm, >= 0 */
  double max_torque_Nm;           /* of the norm, >= 0 */
  double max_speed_m_per_s;       /* of the handle while active, > 0 */
  double max_turn_rate_rad_per_s; /* likewise */
  double ramp_in_s;               /* none to full, 0.001 to 10 */
  double ramp_out_s;              /* full to none, 0.001 to 1 */
  double max_ttl_s;               /* the longest life of a command, 1e-6 to 1 */
} dh_gate_limits;

/* A host that was heard. */
typedef struct dh_gate_session {
  uint32_t session;   /* 0 for an empty place */
  uint32_t sequence;  /* of the newest command that was accepted */
  uint8_t may_enable; /* that command disabled, and nothing has ended it */
} dh_gate_session;

/* Read what you like; change it through the functions. */
typedef struct dh_gate {
  dh_gate_limits limits;
  dh_gate_state state;
  dh_fault fault;            /* DH_FAULT_NONE but in DH_FAULT */
  uint32_t session;          /* served while active, else 0 */
  uint32_t command_sequence; /* of the newest command that was accepted */
  uint8_t enabled;           /* while active: what the newest command asks */
  double command_F_BH[6];    /* the newest wrench to show, within the limits */
  double scale;              /* of it that is shown, 0 to 1 */
  double F_BH[6];            /* the wrench that is shown */
  uint64_t now_ns;           /* the latest time that was told */
  uint64_t received_ns;      /* when the newest command came, while active */
  uint64_t ttl_ns;           /* its time to live */
  uint64_t slewed_ns;        /* up to when `scale` is */
  uint64_t counts[DH_VERDICT_COUNT];                /* packets by verdict */
  dh_gate_session sessions[DH_REMEMBERED_SESSIONS]; /* latest heard first */
} dh_gate;

/* Limits for a device of that strength: in over 200 ms, out within 20 ms, a
 * handle below 2 m/s and 30 rad/s, commands that live 100 ms at most. */
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

static inline int dh_are_possible_limits(const dh_gate_limits* limits) {
  return dh_is_within(limits->max_force_N, 0, FLT_MAX) &&
         dh_is_within(limits->max_torque_Nm, 0, FLT_MAX) &&
         dh_is_within(limits->max_speed_m_per_s, DBL_MIN, DBL_MAX) &&
         dh_is_within(limits->max_turn_rate_rad_per_s, DBL_MIN, DBL_MAX) &&
         dh_is_within(limits->ramp_in_s, 0.001, 10) &&
         dh_is_within(limits->ramp_out_s, 0.001, 1) &&
         dh_is_within(limits->max_ttl_s, 1e-6, 1);
}

/* Makes a gate that is idle and has heard nobody. Returns 0, and a gate that
 * never shows any wrench, if the limits are not possible ones. */
static inline int dh_gate_init(dh_gate* gate, const dh_gate_limits* limits) {
  const int possible = dh_are_possible_limits(limits);
  memset(gate, 0, sizeof *gate);
  gate->limits = possible ? *limits : dh_gate_default_limits(0, 0);
  gate->state = DH_IDLE;
  gate->fault = DH_FAULT_NONE;
  return possible;
}

/* How many packets were refused. */
static inline uint64_t dh_gate_rejected(const dh_gate* gate) {
  uint64_t sum = 0;
  int i;
  for (i = DH_ACCEPTED + 1; i < DH_VERDICT_COUNT; ++i) sum += gate->counts[i];
  return sum;
}

static inline int dh_are_finite(const double* values, int count) {
  int i;
  for (i = 0; i < count; ++i) {
    if (!dh_is_finite(values[i])) return 0;
  }
  return 1;
}

/* The norm of a finite vector as largest * norm, which 1e308 cannot overflow:
 * divides v by its largest component and returns that. */
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

/* A finite vector, shortened to the limit where it is longer. */
static inline void dh_clamp_norm(const double v[3], double limit,
                                 double out[3]) {
  double unit[3], norm;
  const double largest = dh_split_norm(v, unit, &norm);
  /* By four round-offs less, so that nobody who forms the norm of what comes
   * out finds it above the limit. */
  const double allowed = limit * (1 - 4 * DBL_EPSILON);
  int i;
  for (i = 0; i < 3; ++i) {
    out[i] = largest > 0 && largest > allowed / norm
                 ? unit[i] * (allowed / norm)
                 : v[i];
  }
}

static inline void dh_gate_release(dh_gate* gate, dh_gate_state state,
                                   dh_fault fault) {
  gate->state = state;
  gate->fault = fault;
  gate->session = 0;
  gate->enabled = 0;
  gate->scale = 0;
  memset(gate->command_F_BH, 0, sizeof gate->command_F_BH);
  memset(gate->F_BH, 0, sizeof gate->F_BH);
}

/* From now on no host may enable before it has disabled once more. */
static inline void dh_gate_forget_permissions(dh_gate* gate) {
  int i;
  for (i = 0; i < DH_REMEMBERED_SESSIONS; ++i) {
    gate->sessions[i].may_enable = 0;
  }
}

/* Zero at once, and latched. The first cause is kept. */
static inline void dh_gate_enter_fault(dh_gate* gate, dh_fault fault) {
  dh_gate_release(gate, DH_FAULT,
                  gate->state == DH_FAULT ? gate->fault : fault);
  dh_gate_forget_permissions(gate);
}

/* The driver's own hardware is at fault. */
static inline void dh_gate_fail(dh_gate* gate) {
  dh_gate_enter_fault(gate, DH_FAULT_DEVICE);
}

/* Takes the time in. A clock that went backwards is a fault, and 0. */
static inline int dh_gate_advance(dh_gate* gate, uint64_t now_ns) {
  const int forwards = now_ns >= gate->now_ns;
  if (!forwards) dh_gate_enter_fault(gate, DH_FAULT_CLOCK);
  gate->now_ns = now_ns;
  return forwards;
}

/* The place of that session; DH_REMEMBERED_SESSIONS if it is not remembered. */
static inline int dh_gate_find(const dh_gate* gate, uint32_t session) {
  int i = 0;
  while (i < DH_REMEMBERED_SESSIONS && gate->sessions[i].session != session) {
    ++i;
  }
  return i;
}

/* Puts the session first, with the command as its newest; the one that was
 * heard longest ago makes room. */
static inline void dh_gate_remember(dh_gate* gate, const dh_command* command) {
  int i = dh_gate_find(gate, command->session);
  if (i == DH_REMEMBERED_SESSIONS) --i;
  for (; i > 0; --i) gate->sessions[i] = gate->sessions[i - 1];
  gate->sessions[0].session = command->session;
  gate->sessions[0].sequence = command->sequence;
  gate->sessions[0].may_enable = !command->enable;
  gate->command_sequence = command->sequence;
}

/* Whether a well-formed command is to be obeyed. */
static inline dh_verdict dh_gate_judge(const dh_gate* gate,
                                       const dh_command* command) {
  const int place = dh_gate_find(gate, command->session);
  const int known = place < DH_REMEMBERED_SESSIONS;
  if (gate->state == DH_ACTIVE && command->session != gate->session) {
    return DH_FOREIGN_SESSION;
  }
  if (known &&
      !dh_is_newer(command->sequence, gate->sessions[place].sequence)) {
    return DH_OLD_SEQUENCE;
  }
  if (command->enable && gate->state == DH_FAULT) return DH_AT_FAULT;
  if (command->enable && gate->state == DH_IDLE &&
      !(known && gate->sessions[place].may_enable)) {
    return DH_NOT_DISABLED_FIRST;
  }
  return dh_are_finite(command->F_BH, 6) ? DH_ACCEPTED : DH_NOT_FINITE;
}

static inline void dh_gate_obey(dh_gate* gate, const dh_command* command) {
  if (!command->enable) {
    gate->enabled = 0; /* while active, the step ramps out */
    if (gate->state == DH_FAULT) dh_gate_release(gate, DH_IDLE, DH_FAULT_NONE);
    return;
  }
  if (gate->state == DH_IDLE) {
    dh_gate_forget_permissions(gate);
    gate->state = DH_ACTIVE;
    gate->session = command->session;
    gate->slewed_ns = gate->now_ns;
  }
  gate->enabled = 1;
  gate->received_ns = gate->now_ns;
  gate->ttl_ns = UINT64_C(1000) * command->ttl_us;
  if ((double)gate->ttl_ns > 1e9 * gate->limits.max_ttl_s) {
    gate->ttl_ns = (uint64_t)(1e9 * gate->limits.max_ttl_s);
  }
  dh_clamp_norm(command->F_BH, gate->limits.max_torque_Nm, gate->command_F_BH);
  dh_clamp_norm(command->F_BH + 3, gate->limits.max_force_N,
                gate->command_F_BH + 3);
}

/* Takes a packet in. What is refused changes nothing but the counts, except
 * that a wrench that is not finite and a clock that went backwards are faults.
 */
static inline dh_verdict dh_gate_receive(dh_gate* gate, uint64_t now_ns,
                                         const uint8_t* bytes, size_t size) {
  dh_command command;
  dh_verdict verdict = DH_CLOCK_WENT_BACK;
  if (dh_gate_advance(gate, now_ns)) {
    verdict = dh_unpack_command(bytes, size, &command);
    if (verdict == DH_ACCEPTED) verdict = dh_gate_judge(gate, &command);
    if (verdict == DH_ACCEPTED) {
      dh_gate_remember(gate, &command);
      dh_gate_obey(gate, &command);
    }
    if (verdict == DH_NOT_FINITE) {
      dh_gate_enter_fault(gate, DH_FAULT_NOT_FINITE);
    }
  }
  ++gate->counts[verdict];
  return verdict;
}

/* Moves the scale on. It rises by a twentieth in one step at most, however late
 * the step comes; it falls by all the time that has passed. */
static inline void dh_gate_slew(dh_gate* gate, int shown) {
  const double passed_s = 1e-9 * (double)(gate->now_ns - gate->slewed_ns);
  if (shown) {
    const double rise = passed_s / gate->limits.ramp_in_s;
    gate->scale += rise < 0.05 ? rise : 0.05;
    if (gate->scale > 1) gate->scale = 1;
  } else {
    gate->scale -= passed_s / gate->limits.ramp_out_s;
    if (gate->scale < 1e-9) gate->scale = 0;
  }
  gate->slewed_ns = gate->now_ns;
}

/* Moves the time on and gives the wrench to show, F_BH, from the handle's pose
 * and velocity. Call it in each tick, in all states. */
static inline void dh_gate_step(dh_gate* gate, uint64_t now_ns,
                                const double X_BH[7], const double V_BH[6],
                                double F_BH[6]) {
  int i;
  dh_gate_advance(gate, now_ns);
  if (!dh_are_finite(X_BH, 7) || !dh_are_finite(V_BH, 6)) {
    dh_gate_enter_fault(gate, DH_FAULT_NOT_FINITE);
  }
  if (gate->state == DH_ACTIVE &&
      (dh_exceeds(V_BH, gate->limits.max_turn_rate_rad_per_s) ||
       dh_exceeds(V_BH + 3, gate->limits.max_speed_m_per_s))) {
    dh_gate_enter_fault(gate, DH_FAULT_OVERSPEED);
  }
  if (gate->state == DH_ACTIVE) {
    const int fresh = gate->now_ns - gate->received_ns <= gate->ttl_ns;
    dh_gate_slew(gate, gate->enabled && fresh);
    for (i = 0; i < 6; ++i) gate->F_BH[i] = gate->scale * gate->command_F_BH[i];
    if (gate->scale <= 0 && !gate->enabled) {
      dh_gate_release(gate, DH_IDLE, DH_FAULT_NONE);
    } else if (gate->scale <= 0 && !fresh) {
      dh_gate_enter_fault(gate, DH_FAULT_STALE);
    }
  }
  memcpy(F_BH, gate->F_BH, sizeof gate->F_BH);
}

/* Fills in what a gate knows of a state: whom it serves, what it shows, its
 * limits and how it stands. The rest is the driver's. */
static inline void dh_gate_tell(const dh_gate* gate, dh_state* state) {
  state->session = gate->session;
  memcpy(state->F_BH, gate->F_BH, sizeof gate->F_BH);
  state->command_sequence = gate->command_sequence;
  state->rejected = (uint32_t)(dh_gate_rejected(gate) & 0xffffffff);
  state->max_force_N = (float)gate->limits.max_force_N;
  state->max_torque_Nm = (float)gate->limits.max_torque_Nm;
  state->gate = (uint8_t)gate->state;
  state->fault = (uint8_t)gate->fault;
}

#endif /* DRAKE_HAPTICS_GATE_H_ */
