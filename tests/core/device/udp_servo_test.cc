// The servo between a program and a driver, both of which use it at once. Also
// runs under the thread sanitizer.
#include "device/udp_servo.h"

#include <cmath>
#include <limits>
#include <thread>

#include "check.h"
#include "driver.h"

namespace drake_haptics {
namespace {

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
  long k = 0;
  WaitUntil([&] {
    for (int asked = 0; asked < 100; ++asked) {
      const HandleState state = servo.Read();
      CHECK(state.number >= last);
      last = state.number;
      wrench.F[3] = state.number % 80 >= 60 ? std::nan("") : 10.0;
      servo.Publish(wrench);
      CHECK(servo.status().is_running);
      CHECK(std::isfinite(servo.lateness().Quantile(0.99)));
      if (k++ % 1000 == 0) servo.Recover();
    }
    return driver.num_pushes() >= 200 && servo.status().num_not_finite > 0;
  });
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
