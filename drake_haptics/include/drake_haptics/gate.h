/* The gate: it protects a hand from commands of any origin.
 *
 * It runs in the driver, beside the hardware, and decides which commands are
 * obeyed and which wrench is shown. It is a pure state machine: no clock, no
 * socket, no allocation; time is an argument, the work of a call is bounded,
 * and force and torque never exceed the limits in any state. For its diagram
 * see docs/device-protocol.md. In each tick a driver calls, in this order:
 *
 *   dh_gate_receive()  for each packet received, up to some bound
 *   dh_gate_fail()     if its own hardware is at fault
 *   dh_gate_step()     once, and shows the wrench that it returns
 *
 * C99, and C++ as well. Needs sqrt() of the C library (-lm). */
#ifndef DRAKE_HAPTICS_GATE_H_
#define DRAKE_HAPTICS_GATE_H_

#include "limits.h"
#include "wire.h"

enum { DH_REMEMBERED_SESSIONS = 8 };

/* A host that sent a command which was accepted. */
typedef struct dh_gate_session {
  uint32_t session;   /* 0 if the entry is empty */
  uint32_t sequence;  /* sequence of its newest accepted command */
  uint8_t may_enable; /* it disabled first, and may enable now */
} dh_gate_session;

/* A gate. Read any field, but change it only through the functions. */
typedef struct dh_gate {
  dh_gate_limits limits;
  dh_gate_state state;
  dh_fault fault;            /* DH_FAULT_NONE except in DH_FAULT */
  uint32_t session;          /* session served while active, else 0 */
  uint32_t command_sequence; /* sequence of the newest accepted command */
  uint8_t enabled;           /* while active: if the newest command enables */
  double command_F_Ho_B[6];  /* newest commanded wrench, within the limits */
  double scale;              /* share of that wrench that is shown, 0 to 1 */
  double F_Ho_B[6];          /* the wrench that is shown */
  uint64_t now_ns;           /* time of the latest call */
  uint64_t received_ns;      /* time of the newest enabling command */
  uint64_t ttl_ns;           /* time to live of that command */
  uint64_t counts[DH_VERDICT_COUNT];                /* packets by verdict */
  dh_gate_session sessions[DH_REMEMBERED_SESSIONS]; /* most recent first */
} dh_gate;

/* Makes an idle gate that knows no host. Returns NULL, or why the limits are
 * invalid; the gate then never shows any wrench. */
static inline const char* dh_gate_init(dh_gate* gate,
                                       const dh_gate_limits* limits) {
  const char* problem = dh_limits_problem(limits);
  memset(gate, 0, sizeof *gate);
  gate->limits = problem ? dh_gate_default_limits(0, 0) : *limits;
  gate->state = DH_IDLE;
  gate->fault = DH_FAULT_NONE;
  return problem;
}

/* Number of packets refused. */
static inline uint64_t dh_gate_rejected(const dh_gate* gate) {
  uint64_t sum = 0;
  int i;
  for (i = DH_ACCEPTED + 1; i < DH_VERDICT_COUNT; ++i) sum += gate->counts[i];
  return sum;
}

static inline void dh_gate_release(dh_gate* gate, dh_gate_state state,
                                   dh_fault fault) {
  gate->state = state;
  gate->fault = fault;
  gate->session = 0;
  gate->enabled = 0;
  gate->scale = 0;
  memset(gate->command_F_Ho_B, 0, sizeof gate->command_F_Ho_B);
  memset(gate->F_Ho_B, 0, sizeof gate->F_Ho_B);
}

/* After this, a host must disable again before it may enable. */
static inline void dh_gate_forget_permissions(dh_gate* gate) {
  int i;
  for (i = 0; i < DH_REMEMBERED_SESSIONS; ++i) {
    gate->sessions[i].may_enable = 0;
  }
}

/* Zeroes the wrench at once and latches the fault. Keeps the first cause. */
static inline void dh_gate_enter_fault(dh_gate* gate, dh_fault fault) {
  dh_gate_release(gate, DH_FAULT,
                  gate->state == DH_FAULT ? gate->fault : fault);
  dh_gate_forget_permissions(gate);
}

/* Reports a fault of the driver's own hardware. */
static inline void dh_gate_fail(dh_gate* gate) {
  dh_gate_enter_fault(gate, DH_FAULT_DEVICE);
}

/* Ramps in while commands are fresh, else out; at zero the gate is idle or at
 * fault. The scale rises by at most a twentieth per call, however late the
 * call. */
static inline void dh_gate_ramp(dh_gate* gate, uint64_t passed_ns) {
  const uint64_t age_ns = gate->now_ns - gate->received_ns;
  const int fresh = age_ns <= gate->ttl_ns;
  int i;
  if (gate->enabled && fresh) {
    const double rise = 1e-9 * (double)passed_ns / gate->limits.ramp_in_s;
    gate->scale += rise < 0.05 ? rise : 0.05;
    if (gate->scale > 1) gate->scale = 1;
  } else {
    if (gate->enabled && age_ns - gate->ttl_ns < passed_ns) {
      passed_ns = age_ns - gate->ttl_ns; /* time since the command went stale */
    }
    gate->scale -= 1e-9 * (double)passed_ns / gate->limits.ramp_out_s;
    if (gate->scale < 1e-9) gate->scale = 0; /* round-off */
  }
  for (i = 0; i < 6; ++i)
    gate->F_Ho_B[i] = gate->scale * gate->command_F_Ho_B[i];
  if (gate->scale > 0) return;
  if (!gate->enabled) dh_gate_release(gate, DH_IDLE, DH_FAULT_NONE);
  if (gate->enabled && !fresh) dh_gate_enter_fault(gate, DH_FAULT_STALE);
}

/* Advances the time. If the clock went backwards, faults and returns 0. */
static inline int dh_gate_advance(dh_gate* gate, uint64_t now_ns) {
  const uint64_t before_ns = gate->now_ns;
  gate->now_ns = now_ns;
  if (now_ns < before_ns) {
    dh_gate_enter_fault(gate, DH_FAULT_CLOCK);
    return 0;
  }
  if (gate->state == DH_ACTIVE) dh_gate_ramp(gate, now_ns - before_ns);
  return 1;
}

/* Index of the session; DH_REMEMBERED_SESSIONS if it is not remembered. */
static inline int dh_gate_find(const dh_gate* gate, uint32_t session) {
  int i = 0;
  while (i < DH_REMEMBERED_SESSIONS && gate->sessions[i].session != session) {
    ++i;
  }
  return i;
}

/* Puts the session first, with this command as its newest. A new session
 * replaces the least recent one. */
static inline void dh_gate_remember(dh_gate* gate, const dh_command* command) {
  int i = dh_gate_find(gate, command->session);
  if (i == DH_REMEMBERED_SESSIONS) --i;
  for (; i > 0; --i) gate->sessions[i] = gate->sessions[i - 1];
  gate->sessions[0].session = command->session;
  gate->sessions[0].sequence = command->sequence;
  gate->sessions[0].may_enable = !command->enable;
  gate->command_sequence = command->sequence;
}

/* Verdict on a well-formed command: DH_ACCEPTED if it is to be obeyed. */
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
  return dh_are_finite(command->F_Ho_B, 6) ? DH_ACCEPTED : DH_NOT_FINITE;
}

static inline void dh_gate_obey(dh_gate* gate, const dh_command* command) {
  if (!command->enable) {
    gate->enabled = 0; /* while active, the wrench ramps out */
    if (gate->state == DH_FAULT) dh_gate_release(gate, DH_IDLE, DH_FAULT_NONE);
    return;
  }
  if (gate->state == DH_IDLE) {
    dh_gate_forget_permissions(gate);
    gate->state = DH_ACTIVE;
    gate->session = command->session;
  }
  gate->enabled = 1;
  gate->received_ns = gate->now_ns;
  gate->ttl_ns = UINT64_C(1000) * command->ttl_us;
  if ((double)gate->ttl_ns > 1e9 * gate->limits.max_ttl_s) {
    gate->ttl_ns = (uint64_t)(1e9 * gate->limits.max_ttl_s);
  }
  dh_clamp_norm(command->F_Ho_B, gate->limits.max_torque_Nm,
                gate->command_F_Ho_B);
  dh_clamp_norm(command->F_Ho_B + 3, gate->limits.max_force_N,
                gate->command_F_Ho_B + 3);
}

/* Receives a packet. A refused packet changes only the counts, except that a
 * wrench that is not finite and a clock that went backwards are faults. */
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

/* Advances the time, checks the handle's pose and velocity and returns the
 * wrench to show. Call it in each tick, in all states. */
static inline void dh_gate_step(dh_gate* gate, uint64_t now_ns,
                                const double X_BH[7], const double V_BH[6],
                                double F_Ho_B[6]) {
  dh_gate_advance(gate, now_ns);
  if (!dh_are_finite(X_BH, 7) || !dh_are_finite(V_BH, 6)) {
    dh_gate_enter_fault(gate, DH_FAULT_NOT_FINITE);
  }
  if (gate->state == DH_ACTIVE &&
      (dh_exceeds(V_BH, gate->limits.max_turn_rate_rad_per_s) ||
       dh_exceeds(V_BH + 3, gate->limits.max_speed_m_per_s))) {
    dh_gate_enter_fault(gate, DH_FAULT_OVERSPEED);
  }
  memcpy(F_Ho_B, gate->F_Ho_B, sizeof gate->F_Ho_B);
}

/* Fills in the gate's fields of a state: session, shown wrench, newest command,
 * refusals, limits, gate state and fault. The driver fills in the rest. */
static inline void dh_gate_tell(const dh_gate* gate, dh_state* state) {
  state->session = gate->session;
  memcpy(state->F_Ho_B, gate->F_Ho_B, sizeof gate->F_Ho_B);
  state->command_sequence = gate->command_sequence;
  state->rejected = (uint32_t)(dh_gate_rejected(gate) & 0xffffffff);
  state->max_force_N = (float)gate->limits.max_force_N;
  state->max_torque_Nm = (float)gate->limits.max_torque_Nm;
  state->gate = (uint8_t)gate->state;
  state->fault = (uint8_t)gate->fault;
}

#endif /* DRAKE_HAPTICS_GATE_H_ */
