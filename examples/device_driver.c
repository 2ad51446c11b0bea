/* A whole driver of a haptic device, to start one of your own from.

cc -O2 -o device_driver device_driver.c -lm \
  "-I$(python -c 'import drake_haptics as d; print(d.get_include())')"
./device_driver
*/

/* It serves a handle of 0.2 kg that a hand holds by a spring, in three axes, at
 * 1 kHz, until it is interrupted. "VENDOR" marks the three places where a real
 * device's SDK is called instead; docs/device-protocol.md names the calls. The
 * arguments are PORT and LONGEST_TIME_TO_LIVE_S, where others are wanted. */
#define _POSIX_C_SOURCE 200809L

#include <arpa/inet.h>
#include <drake_haptics/gate.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>

#define PERIOD_NS UINT64_C(1000000)
#define PERIOD_S 0.001
/* More in one tick wait for the next, so that a flood cannot delay a tick. */
#define MAX_PACKETS_PER_TICK 64

static volatile sig_atomic_t interrupted = 0;

static void interrupt(int signal_number) {
  (void)signal_number;
  interrupted = 1;
}

/* Goes on while the machine is suspended, where there is such a clock: what was
 * commanded before is stale after that. */
#ifdef CLOCK_BOOTTIME
#define DRIVER_CLOCK CLOCK_BOOTTIME
#else
#define DRIVER_CLOCK CLOCK_MONOTONIC
#endif

static uint64_t clock_ns(void) {
  struct timespec now;
  clock_gettime(DRIVER_CLOCK, &now);
  return UINT64_C(1000000000) * (uint64_t)now.tv_sec + (uint64_t)now.tv_nsec;
}

/* Waits for the next tick; those that were missed are left out, not made up. */
static void wait_for_tick(uint64_t* next_ns) {
  const uint64_t now_ns = clock_ns();
  struct timespec rest = {0, 0};
  *next_ns += PERIOD_NS;
  if (*next_ns <= now_ns) {
    *next_ns = now_ns;
    return;
  }
  rest.tv_nsec = (long)(*next_ns - now_ns);
  nanosleep(&rest, NULL);
}

/* The device: position and velocity of a point, in its base frame B. */
typedef struct handle {
  double p[3]; /* m */
  double v[3]; /* m/s */
} handle;

/* VENDOR: open the device and calibrate it; arm the SDK's own watchdog. */
static int open_handle(handle* device) {
  memset(device, 0, sizeof *device);
  return 1;
}

/* VENDOR: read pose, velocity and buttons; convert to SI and to B. Returns 0 if
 * the SDK reports an error. */
static int read_handle(const handle* device, dh_state* state) {
  memset(state->X_BH, 0, sizeof state->X_BH);
  memset(state->V_BH, 0, sizeof state->V_BH);
  state->X_BH[0] = 1; /* it does not turn */
  memcpy(state->X_BH + 4, device->p, sizeof device->p);
  memcpy(state->V_BH + 3, device->v, sizeof device->v);
  state->buttons = 0;
  return 1;
}

/* VENDOR: set force and torque, N and N m, on the handle. Here the wrench moves
 * the handle against the spring and damper of a hand for one period. */
static void show_wrench(handle* device, const double F_Ho_B[6]) {
  const double mass_kg = 0.2, spring_N_per_m = 300, damping_Ns_per_m = 5;
  int i;
  for (i = 0; i < 3; ++i) {
    const double hand_N =
        -spring_N_per_m * device->p[i] - damping_Ns_per_m * device->v[i];
    device->v[i] += PERIOD_S * (F_Ho_B[3 + i] + hand_N) / mass_kg;
    device->p[i] += PERIOD_S * device->v[i];
  }
}

/* What a person may send a driver ends it, at zero force: a terminal that is
 * closed too (unless it was started to outlive it, as by nohup), and Ctrl-Z, as
 * what stands still cannot take its force away. */
static void catch_signals(void) {
  struct sigaction action, before;
  memset(&action, 0, sizeof action);
  action.sa_handler = interrupt;
  sigaction(SIGINT, &action, NULL);
  sigaction(SIGTERM, &action, NULL);
  sigaction(SIGTSTP, &action, NULL);
  sigaction(SIGHUP, NULL, &before);
  if (before.sa_handler != SIG_IGN) sigaction(SIGHUP, &action, NULL);
}

static int open_socket(uint16_t port) {
  struct sockaddr_in address;
  socklen_t size = sizeof address;
  const int fd = socket(AF_INET, SOCK_DGRAM, 0);
  memset(&address, 0, sizeof address);
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  /* The protocol has no passwords: listen where only your host can speak. */
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  if (fd < 0 || bind(fd, (struct sockaddr*)&address, sizeof address) != 0 ||
      getsockname(fd, (struct sockaddr*)&address, &size) != 0 ||
      fcntl(fd, F_SETFL, O_NONBLOCK) != 0) {
    perror("device_driver: the UDP port cannot be had");
    return -1;
  }
  printf("listening on udp://127.0.0.1:%u\n",
         (unsigned)ntohs(address.sin_port));
  fflush(stdout);
  return fd;
}

/* Whether the sender is the one to answer: who is obeyed, or must learn why
 * not. */
static int is_to_be_answered(dh_verdict verdict) {
  return verdict == DH_ACCEPTED || verdict == DH_NOT_DISABLED_FIRST ||
         verdict == DH_AT_FAULT;
}

/* Gives the gate what has come. */
static void receive_commands(int fd, dh_gate* gate, struct sockaddr_in* host) {
  int i;
  for (i = 0; i < MAX_PACKETS_PER_TICK; ++i) {
    uint8_t bytes[DH_COMMAND_SIZE + 1]; /* one more, to see what is too long */
    struct sockaddr_in sender;
    socklen_t sender_size = sizeof sender;
    const ssize_t size = recvfrom(fd, bytes, sizeof bytes, 0,
                                  (struct sockaddr*)&sender, &sender_size);
    if (size < 0) return; /* nothing more, or nobody listens there any more */
    if (is_to_be_answered(
            dh_gate_receive(gate, clock_ns(), bytes, (size_t)size))) {
      *host = sender;
    }
  }
}

static void send_state(int fd, const dh_gate* gate,
                       const struct sockaddr_in* host, dh_state* state) {
  uint8_t bytes[DH_STATE_SIZE];
  if (host->sin_port == 0) return; /* nobody has spoken yet */
  ++state->sequence;
  state->time_ns = clock_ns();
  dh_gate_tell(gate, state);
  dh_pack_state(state, bytes);
  /* A host that does not listen now is no reason to stop. */
  (void)sendto(fd, bytes, sizeof bytes, 0, (const struct sockaddr*)host,
               sizeof *host);
}

/* A number that differs from run to run, and is not 0. */
static uint32_t draw_boot_number(void) {
  const uint64_t seed = clock_ns() ^ ((uint64_t)getpid() << 32);
  return dh_crc32((const uint8_t*)&seed, sizeof seed) | 1;
}

static void serve(int fd, handle* device, dh_gate* gate) {
  struct sockaddr_in host;
  dh_state state;
  double F_Ho_B[6];
  uint64_t next_ns = clock_ns();
  memset(&host, 0, sizeof host);
  memset(&state, 0, sizeof state);
  state.boot = draw_boot_number();
  while (!interrupted) {
    wait_for_tick(&next_ns);
    receive_commands(fd, gate, &host);
    if (!read_handle(device, &state)) dh_gate_fail(gate);
    dh_gate_step(gate, clock_ns(), state.X_BH, state.V_BH, F_Ho_B);
    show_wrench(device, F_Ho_B);
    send_state(fd, gate, &host, &state);
  }
  /* However it ends, it ends at zero force, and the host is told. */
  dh_gate_fail(gate);
  show_wrench(device, gate->F_Ho_B);
  send_state(fd, gate, &host, &state);
}

/* Reads the port, the first argument; a wrong one must not become another. */
static int read_port(const char* text, uint16_t* port) {
  char* end;
  const long value = strtol(text, &end, 10);
  if (*text == '\0' || *end != '\0' || value < 0 || value > 65535) return 0;
  *port = (uint16_t)value;
  return 1;
}

int main(int argc, char** argv) {
  /* The device's own: 3.3 N, and no torque. */
  dh_gate_limits limits = dh_gate_default_limits(3.3, 0);
  const char* problem;
  dh_gate gate;
  handle device;
  uint16_t port = 7400;
  int fd;
  if (argc > 3 || (argc > 1 && !read_port(argv[1], &port))) {
    fprintf(stderr, "use: device_driver [PORT [LONGEST_TIME_TO_LIVE_S]]\n");
    return 2;
  }
  if (argc > 2) limits.max_ttl_s = atof(argv[2]);
  problem = dh_gate_init(&gate, &limits);
  if (problem) {
    fprintf(stderr, "device_driver: %s\n", problem);
    return 2;
  }
  catch_signals();
  fd = open_socket(port);
  if (fd < 0) return 1;
  if (!open_handle(&device)) {
    fprintf(stderr, "device_driver: the device cannot be opened\n");
    return 1;
  }
  serve(fd, &device, &gate);
  close(fd);
  printf("stopped at zero force\n");
  return 0;
}
