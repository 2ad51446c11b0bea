/* Calls one function of the protocol so often: protocol_cost CALL TIMES. */
#include <drake_haptics/gate.h>
#include <stdlib.h>

static const double X_BH[7] = {1, 0, 0, 0, 0, 0, 0};
static const double V_BH[6] = {0.1, 0.2, 0.3, 0.1, 0.2, 0.3};

int main(int argc, char** argv) {
  const dh_gate_limits limits = dh_gate_default_limits(8.5, 0.188);
  uint8_t packet[DH_STATE_SIZE];
  double F_Ho_B[6];
  dh_command command;
  dh_state state;
  dh_gate gate;
  int i, times;
  if (argc != 3) return 2;
  times = atoi(argv[2]);
  memset(&state, 0, sizeof state);
  memset(&command, 0, sizeof command);
  state.boot = 1;
  command.session = 1;
  command.ttl_us = 20000;
  command.F_Ho_B[0] = 1;
  command.F_Ho_B[5] = 50; /* both are over the limits */
  dh_gate_init(&gate, &limits);
  dh_pack_command(&command, packet);
  dh_gate_receive(&gate, 0, packet, DH_COMMAND_SIZE);
  command.enable = 1;
  command.sequence = 1;
  dh_pack_command(&command, packet);
  dh_gate_receive(&gate, 0, packet, DH_COMMAND_SIZE);
  if (argv[1][0] == 'u') dh_pack_state(&state, packet);
  for (i = 0; i < times; ++i) {
    const uint64_t now_ns = UINT64_C(1000) * (uint64_t)i;
    switch (argv[1][0]) {
      case 'p':
        state.sequence = (uint32_t)i;
        dh_pack_state(&state, packet);
        break;
      case 'u':
        dh_unpack_state(packet, sizeof packet, &state);
        break;
      case 'c':
        command.sequence = (uint32_t)i;
        dh_pack_command(&command, packet);
        break;
      case 'r': /* what it costs beyond packing is told by 'c' */
        command.sequence = (uint32_t)i + 2;
        dh_pack_command(&command, packet);
        dh_gate_receive(&gate, now_ns, packet, DH_COMMAND_SIZE);
        break;
      default:
        dh_gate_step(&gate, now_ns, X_BH, V_BH, F_Ho_B);
    }
  }
  return gate.state != DH_ACTIVE;
}
