#pragma once

#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <cmath>
#include <limits>
#include <thread>

#include "check.h"
#include "drake_haptics/wire.h"

namespace drake_haptics {

inline constexpr double kMaxForce = 8.5, kMaxTorque = 0.5;

// A device that answers each command with its next state. It does as it is
// asked, and holds every command to what it may be.
class Driver {
 public:
  Driver() : socket_(socket(AF_INET, SOCK_DGRAM, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    CHECK(bind(socket_, reinterpret_cast<sockaddr*>(&address),
               sizeof address) == 0);
    socklen_t size = sizeof address;
    getsockname(socket_, reinterpret_cast<sockaddr*>(&address), &size);
    port_ = ntohs(address.sin_port);
    const timeval patience{0, 100'000};
    setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
    thread_ = std::thread([this] { Run(); });
  }
  ~Driver() {
    End();
    close(socket_);
  }

  // Where the handle is from now on, m above its base.
  void MoveTo(double height) { height_ = height; }

  void End() {
    ends_ = true;
    if (thread_.joinable()) thread_.join();
  }

  std::uint16_t port() const { return port_; }
  long num_pushes() const { return num_pushes_; }

  // Once ended.
  int num_disables_at_end() const { return num_disables_; }

 private:
  void Run() {
    while (true) {
      sockaddr_in peer{};
      socklen_t size = sizeof peer;
      unsigned char packet[512];
      const ssize_t got = recvfrom(socket_, packet, sizeof packet, 0,
                                   reinterpret_cast<sockaddr*>(&peer), &size);
      if (got < 0) {
        if (ends_) return;
        continue;
      }
      dh_command command{};
      CHECK(dh_unpack_command(packet, static_cast<std::size_t>(got),
                              &command) == DH_ACCEPTED);
      Hold(command);
      Answer(command, peer);
    }
  }

  void Hold(const dh_command& command) {
    const double* F = command.F_Ho_B;
    const double force = std::hypot(F[3], F[4], F[5]);
    CHECK(force <= kMaxForce * (1 + 1e-12));
    CHECK(std::hypot(F[0], F[1], F[2]) <= kMaxTorque * (1 + 1e-12));
    if (!command.enable) CHECK(force == 0);
    if (force > 0) ++num_pushes_;
    num_disables_ = command.enable ? 0 : num_disables_ + 1;
  }

  // Now and then with a mad state before the good one: the servo answers none
  // of those.
  void Answer(const dh_command& command, const sockaddr_in& peer) {
    if (command.sequence % 50 == 0) {
      SendState(command, peer, std::numeric_limits<double>::quiet_NaN());
    }
    SendState(command, peer, 0);
  }

  void SendState(const dh_command& command, const sockaddr_in& peer,
                 double speed) {
    dh_state state{};
    state.session = command.session;
    state.sequence = ++sequence_;
    state.time_ns = 1'000'000ull * sequence_;
    state.X_BH[0] = 1;
    state.X_BH[6] = height_;
    state.V_BH[3] = speed;
    state.boot = 7;
    state.command_sequence = command.sequence;
    state.max_force_N = kMaxForce;
    state.max_torque_Nm = kMaxTorque;
    state.gate = command.enable ? DH_ACTIVE : DH_IDLE;
    unsigned char packet[DH_STATE_SIZE];
    dh_pack_state(&state, packet);
    sendto(socket_, packet, sizeof packet, 0,
           reinterpret_cast<const sockaddr*>(&peer), sizeof peer);
  }

  const int socket_;
  std::uint16_t port_ = 0;
  std::uint32_t sequence_ = 0;
  int num_disables_ = 0;
  std::atomic<long> num_pushes_{0};
  std::atomic<double> height_{0};
  std::atomic<bool> ends_{false};
  std::thread thread_;
};

}  // namespace drake_haptics
