/* The packets between a host and the driver of a haptic device, version 1.
 *
 * C99, and C++ as well; no dependency, no allocation. Numbers are little-endian
 * and written byte by byte, so neither the machine's byte order nor alignment
 * matters; floating point is IEEE 754. docs/device-protocol.md has the layout
 * as tables, and says who sends what when.
 *
 * SI units. B is the frame of the device's base, H that of its handle, Ho the
 * handle's origin. Poses are [qw qx qy qz x y z], velocities [omega; v],
 * wrenches [tau; f]. */
#ifndef DRAKE_HAPTICS_WIRE_H_
#define DRAKE_HAPTICS_WIRE_H_

#include <stddef.h>
#include <stdint.h>
#include <string.h>

enum {
  DH_WIRE_VERSION = 1,
  DH_HEADER_SIZE = 24,  /* bytes */
  DH_STATE_SIZE = 208,  /* bytes */
  DH_COMMAND_SIZE = 88, /* bytes */
  DH_KIND_STATE = 1,
  DH_KIND_COMMAND = 2,
  DH_FLAG_ENABLE = 1
};

/* Whether a device shows force. */
typedef enum dh_gate_state {
  DH_IDLE = 0,   /* no force; waits to be enabled */
  DH_ACTIVE = 1, /* shows the commanded wrench, within its limits */
  DH_FAULT = 2   /* no force until a host disables */
} dh_gate_state;

/* Why a device is in DH_FAULT. */
typedef enum dh_fault {
  DH_FAULT_NONE = 0,
  DH_FAULT_STALE = 1,      /* commands stopped for longer than their life */
  DH_FAULT_NOT_FINITE = 2, /* NaN or infinity in command or handle */
  DH_FAULT_OVERSPEED = 3,  /* the handle was faster than allowed */
  DH_FAULT_CLOCK = 4,      /* the driver's clock went backwards */
  DH_FAULT_DEVICE = 5      /* the driver found its hardware at fault */
} dh_fault;

/* Verdict on a packet. Verdicts up to DH_WRONG_FIELD concern the packet alone;
 * the later ones are a gate's (gate.h). */
typedef enum dh_verdict {
  DH_ACCEPTED = 0,
  DH_TOO_SHORT = 1,       /* no room for a header */
  DH_WRONG_MAGIC = 2,     /* not a packet of this protocol */
  DH_WRONG_VERSION = 3,   /* not version 1 */
  DH_WRONG_KIND = 4,      /* not the expected kind */
  DH_WRONG_SIZE = 5,      /* not the size of its kind, or not as it states */
  DH_WRONG_CRC = 6,       /* damaged on its way */
  DH_WRONG_FIELD = 7,     /* a value that version 1 does not have */
  DH_FOREIGN_SESSION = 8, /* another host is being served */
  DH_OLD_SEQUENCE = 9,    /* a duplicate, or older than an accepted one */
  DH_NOT_DISABLED_FIRST = 10, /* enable, but this host did not disable before */
  DH_AT_FAULT = 11,           /* enable, but the fault is still latched */
  DH_NOT_FINITE = 12,         /* a wrench with NaN or infinity: a fault */
  DH_CLOCK_WENT_BACK = 13,    /* the driver's own clock: a fault */
  DH_VERDICT_COUNT = 14
} dh_verdict;

/* State of the device, as its driver sends it. */
typedef struct dh_state {
  uint32_t session;  /* session of the host that is served; 0 for none */
  uint32_t sequence; /* rises by one from packet to packet, and wraps */
  uint64_t time_ns;  /* time of the sample, driver's monotonic clock */
  double X_BH[7];    /* the handle's pose, m */
  double V_BH[6];    /* its spatial velocity, rad/s and m/s */
  double F_Ho_B[6];  /* the wrench shown at Ho, N m and N */
  uint32_t boot;     /* random in each run of the driver, never 0 */
  uint32_t command_sequence; /* sequence of the newest accepted command */
  uint32_t buttons;          /* bit i is set while button i is held */
  uint32_t rejected;         /* packets refused since the driver started */
  float max_force_N;
  float max_torque_Nm;
  uint8_t gate;  /* a dh_gate_state */
  uint8_t fault; /* a dh_fault */
} dh_state;

/* Command of a host. */
typedef struct dh_command {
  uint32_t session;        /* random in each run of the host, never 0 */
  uint32_t sequence;       /* rises by one from packet to packet, and wraps */
  uint64_t time_ns;        /* time of sending, host's monotonic clock */
  double F_Ho_B[6];        /* the wrench to show at Ho, N m and N */
  uint32_t state_sequence; /* sequence of the state that this answers */
  uint32_t ttl_us;         /* time to live, us; then the command is stale */
  uint8_t enable;          /* 1 to show force, 0 to show none */
} dh_command;

/* Whether sequence number a comes after b (serial-number arithmetic, RFC 1982:
 * a is ahead by less than half of all numbers, across the wrap at 2^32). */
static inline int dh_is_newer(uint32_t a, uint32_t b) {
  const uint32_t ahead = a - b;
  return ahead != 0 && ahead < UINT32_C(0x80000000);
}

/* Whether x is neither NaN nor infinite. Tests its bits, since -ffast-math
 * breaks isfinite(). */
static inline int dh_is_finite(double x) {
  uint64_t bits;
  memcpy(&bits, &x, sizeof bits);
  return ((bits >> 52) & 0x7ff) != 0x7ff;
}

/* CRC-32 of zlib, PNG and Ethernet (reflected polynomial 0xEDB88320), a byte at
 * a time: the remainder of a byte is the exclusive or of the remainders of its
 * halves. */
static inline uint32_t dh_crc32(const uint8_t* bytes, size_t size) {
  static const uint32_t kOfLowHalf[16] = {
      0x00000000, 0x77073096, 0xee0e612c, 0x990951ba, 0x076dc419, 0x706af48f,
      0xe963a535, 0x9e6495a3, 0x0edb8832, 0x79dcb8a4, 0xe0d5e91e, 0x97d2d988,
      0x09b64c2b, 0x7eb17cbd, 0xe7b82d07, 0x90bf1d91};
  static const uint32_t kOfHighHalf[16] = {
      0x00000000, 0x1db71064, 0x3b6e20c8, 0x26d930ac, 0x76dc4190, 0x6b6b51f4,
      0x4db26158, 0x5005713c, 0xedb88320, 0xf00f9344, 0xd6d6a3e8, 0xcb61b38c,
      0x9b64c2b0, 0x86d3d2d4, 0xa00ae278, 0xbdbdf21c};
  uint32_t crc = UINT32_C(0xffffffff);
  size_t i;
  for (i = 0; i < size; ++i) {
    const uint32_t byte = (crc ^ bytes[i]) & 0xff;
    crc = (crc >> 8) ^ kOfLowHalf[byte & 15] ^ kOfHighHalf[byte >> 4];
  }
  return ~crc;
}

/* Writes the low `size` bytes of a number, the lowest first. */
static inline void dh_put(uint64_t value, size_t size, uint8_t* bytes) {
  size_t i;
  for (i = 0; i < size; ++i) bytes[i] = (uint8_t)((value >> (8 * i)) & 0xff);
}

static inline uint64_t dh_get(const uint8_t* bytes, size_t size) {
  uint64_t value = 0;
  size_t i;
  for (i = 0; i < size; ++i) value |= (uint64_t)bytes[i] << (8 * i);
  return value;
}

static inline uint32_t dh_get_u32(const uint8_t* bytes) {
  return (uint32_t)dh_get(bytes, 4);
}

static inline void dh_put_reals(const double* values, size_t count,
                                uint8_t* bytes) {
  size_t i;
  for (i = 0; i < count; ++i) {
    uint64_t bits;
    memcpy(&bits, &values[i], sizeof bits);
    dh_put(bits, 8, bytes + 8 * i);
  }
}

static inline void dh_get_reals(const uint8_t* bytes, size_t count,
                                double* values) {
  size_t i;
  for (i = 0; i < count; ++i) {
    const uint64_t bits = dh_get(bytes + 8 * i, 8);
    memcpy(&values[i], &bits, sizeof bits);
  }
}

static inline void dh_put_float(float value, uint8_t* bytes) {
  uint32_t bits;
  memcpy(&bits, &value, sizeof bits);
  dh_put(bits, 4, bytes);
}

static inline float dh_get_float(const uint8_t* bytes) {
  const uint32_t bits = dh_get_u32(bytes);
  float value;
  memcpy(&value, &bits, sizeof value);
  return value;
}

static inline void dh_put_header(uint8_t kind, size_t size, uint32_t session,
                                 uint32_t sequence, uint64_t time_ns,
                                 uint8_t* bytes) {
  memcpy(bytes, "DHAP", 4);
  bytes[4] = DH_WIRE_VERSION;
  bytes[5] = kind;
  dh_put(size, 2, bytes + 6);
  dh_put(session, 4, bytes + 8);
  dh_put(sequence, 4, bytes + 12);
  dh_put(time_ns, 8, bytes + 16);
}

static inline void dh_put_crc(size_t size, uint8_t* bytes) {
  dh_put(dh_crc32(bytes, size - 4), 4, bytes + size - 4);
}

/* Checks that the bytes are one whole packet of this kind and size. */
static inline dh_verdict dh_check_packet(const uint8_t* bytes, size_t size,
                                         uint8_t kind, size_t kind_size) {
  if (size < DH_HEADER_SIZE) return DH_TOO_SHORT;
  if (memcmp(bytes, "DHAP", 4) != 0) return DH_WRONG_MAGIC;
  if (bytes[4] != DH_WIRE_VERSION) return DH_WRONG_VERSION;
  if (bytes[5] != kind) return DH_WRONG_KIND;
  if (size != kind_size || dh_get(bytes + 6, 2) != kind_size) {
    return DH_WRONG_SIZE;
  }
  if (dh_get_u32(bytes + size - 4) != dh_crc32(bytes, size - 4)) {
    return DH_WRONG_CRC;
  }
  return DH_ACCEPTED;
}

/* Writes DH_STATE_SIZE bytes. */
static inline void dh_pack_state(const dh_state* state, uint8_t* bytes) {
  dh_put_header(DH_KIND_STATE, DH_STATE_SIZE, state->session, state->sequence,
                state->time_ns, bytes);
  dh_put_reals(state->X_BH, 7, bytes + 24);
  dh_put_reals(state->V_BH, 6, bytes + 80);
  dh_put_reals(state->F_Ho_B, 6, bytes + 128);
  dh_put(state->boot, 4, bytes + 176);
  dh_put(state->command_sequence, 4, bytes + 180);
  dh_put(state->buttons, 4, bytes + 184);
  dh_put(state->rejected, 4, bytes + 188);
  dh_put_float(state->max_force_N, bytes + 192);
  dh_put_float(state->max_torque_Nm, bytes + 196);
  bytes[200] = state->gate;
  bytes[201] = state->fault;
  dh_put(0, 2, bytes + 202);
  dh_put_crc(DH_STATE_SIZE, bytes);
}

/* Reads a packet; writes `state` only if it returns DH_ACCEPTED. Its numbers
 * may be NaN or infinite. */
static inline dh_verdict dh_unpack_state(const uint8_t* bytes, size_t size,
                                         dh_state* state) {
  const dh_verdict verdict =
      dh_check_packet(bytes, size, DH_KIND_STATE, DH_STATE_SIZE);
  if (verdict != DH_ACCEPTED) return verdict;
  if (dh_get_u32(bytes + 176) == 0 || bytes[200] > DH_FAULT ||
      bytes[201] > DH_FAULT_DEVICE || dh_get(bytes + 202, 2) != 0) {
    return DH_WRONG_FIELD;
  }
  state->session = dh_get_u32(bytes + 8);
  state->sequence = dh_get_u32(bytes + 12);
  state->time_ns = dh_get(bytes + 16, 8);
  dh_get_reals(bytes + 24, 7, state->X_BH);
  dh_get_reals(bytes + 80, 6, state->V_BH);
  dh_get_reals(bytes + 128, 6, state->F_Ho_B);
  state->boot = dh_get_u32(bytes + 176);
  state->command_sequence = dh_get_u32(bytes + 180);
  state->buttons = dh_get_u32(bytes + 184);
  state->rejected = dh_get_u32(bytes + 188);
  state->max_force_N = dh_get_float(bytes + 192);
  state->max_torque_Nm = dh_get_float(bytes + 196);
  state->gate = bytes[200];
  state->fault = bytes[201];
  return DH_ACCEPTED;
}

/* Writes DH_COMMAND_SIZE bytes. */
static inline void dh_pack_command(const dh_command* command, uint8_t* bytes) {
  dh_put_header(DH_KIND_COMMAND, DH_COMMAND_SIZE, command->session,
                command->sequence, command->time_ns, bytes);
  dh_put_reals(command->F_Ho_B, 6, bytes + 24);
  dh_put(command->state_sequence, 4, bytes + 72);
  dh_put(command->ttl_us, 4, bytes + 76);
  dh_put(command->enable ? DH_FLAG_ENABLE : 0, 4, bytes + 80);
  dh_put_crc(DH_COMMAND_SIZE, bytes);
}

/* Reads a packet; writes `command` only if it returns DH_ACCEPTED. Its wrench
 * may be NaN or infinite. */
static inline dh_verdict dh_unpack_command(const uint8_t* bytes, size_t size,
                                           dh_command* command) {
  const dh_verdict verdict =
      dh_check_packet(bytes, size, DH_KIND_COMMAND, DH_COMMAND_SIZE);
  if (verdict != DH_ACCEPTED) return verdict;
  if (dh_get_u32(bytes + 8) == 0 || dh_get_u32(bytes + 80) > DH_FLAG_ENABLE) {
    return DH_WRONG_FIELD;
  }
  command->session = dh_get_u32(bytes + 8);
  command->sequence = dh_get_u32(bytes + 12);
  command->time_ns = dh_get(bytes + 16, 8);
  dh_get_reals(bytes + 24, 6, command->F_Ho_B);
  command->state_sequence = dh_get_u32(bytes + 72);
  command->ttl_us = dh_get_u32(bytes + 76);
  command->enable = (uint8_t)dh_get_u32(bytes + 80);
  return DH_ACCEPTED;
}

#endif /* DRAKE_HAPTICS_WIRE_H_ */
