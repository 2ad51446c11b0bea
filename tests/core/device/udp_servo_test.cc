// The servo between a program and a driver, both of which use it at once. Also
// runs under the thread sanitizer.
#include "device/udp_servo.h"

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
namespace {

constexpr double kMaxForce = 8.5, kMaxTorque = 0.5;

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
  std::atomic<bool> ends_{false};
  std::thread thread_;
};

UdpServoOptions Patient() {
  UdpServoOptions options;
  options.time_to_live = 5;  // nothing times out on a busy machine
  options.times = {5, 0.02, 0.01};
  return options;
}

// A program that reads, publishes and asks as fast as it can, more force than
// is allowed, slopes that would give energy, and what is not a number.
void StaysWithinLimitsWhileAllUseIt() {
  Driver driver;
  UdpServo servo("127.0.0.1", driver.port(), Patient());
  LocalWrench wrench;
  wrench.F << 1, 0, 0, 0, 100, 0;
  wrench.K.setConstant(-300);
  std::int64_t last = 0;
  const auto is_done = [&] {
    return driver.num_pushes() >= 200 && servo.status().num_not_finite > 0;
  };
  for (long k = 0; !is_done(); ++k) {
    const HandleState state = servo.Read();
    CHECK(state.number >= last);
    last = state.number;
    wrench.F[3] = state.number % 80 >= 60 ? std::nan("") : 10.0;
    servo.Publish(wrench);
    CHECK(servo.status().is_running);
    CHECK(std::isfinite(servo.lateness().Quantile(0.99)));
    if (k % 1000 == 0) servo.Recover();
    std::this_thread::yield();
  }
  CHECK(servo.status().num_not_passive > 0);
  CHECK(servo.status().counts.not_finite > 0);
  std::thread others[3];
  for (std::thread& other : others) {
    other = std::thread([&servo] { servo.Close(); });
  }
  servo.Close();
  CHECK(!servo.status().is_running);
  for (std::thread& other : others) other.join();
  driver.End();
  CHECK(driver.num_disables_at_end() >= 5);
}

void EndsWhereNobodyListens() {
  UdpServo servo("127.0.0.1", 9, Patient());
  servo.Publish({});
  CHECK(servo.Read().number == 0);
}

void RefusesWhatItCannotDo() {
  UdpServoOptions options;
  options.max_force = std::nan("");
  CHECK_THROWS(UdpServo("127.0.0.1", 9, options), std::invalid_argument);
  options = {};
  options.times.hold = 0;
  CHECK_THROWS(UdpServo("127.0.0.1", 9, options), std::invalid_argument);
  CHECK_THROWS(UdpServo("no.such.host.invalid", 9, {}), std::runtime_error);
}

}  // namespace
}  // namespace drake_haptics

int main() {
  drake_haptics::StaysWithinLimitsWhileAllUseIt();
  drake_haptics::EndsWhereNobodyListens();
  drake_haptics::RefusesWhatItCannotDo();
  return drake_haptics::FailedChecks() > 0;
}
