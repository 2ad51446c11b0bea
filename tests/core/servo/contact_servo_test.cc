// Contact solved on a thread, between a program and a driver. Also runs under
// the thread sanitizer.
#include "servo/contact_servo.h"

#include <cmath>
#include <thread>

#include "check.h"
#include "driver.h"
#include "servo/pressed_tool.h"

namespace drake_haptics {
namespace {

const CouplingGains kGains{kStiffness, 1.0, 1.0, 4e-3};

UdpServoOptions Patient() {
  UdpServoOptions options;
  options.time_to_live = 5;  // nothing times out on a busy machine
  options.times = {5, 0.02, 0.01};
  return options;
}

ServoTool MakeTool(double period) {
  return {MakeStepper(period),
          PoseVector::Unit(0),
          {Above(kRest + 5e-3), Vec6::Zero()}};
}

// The program only says that it goes on. The tool comes to rest on the plate
// under a handle that is pressed beyond, and the device is pushed.
void TheToolRestsOnThePlate() {
  Driver driver;
  driver.MoveTo(kRest - 5e-3);
  UdpServo servo("127.0.0.1", driver.port(), Patient());
  ContactServo contact(&servo, MakeTool(5e-4));
  CHECK(contact.tool().q_WT == Above(kRest + 5e-3));
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  CHECK(contact.status().num_solved == 0);  // nobody has said so
  CHECK(!servo.status().is_active);
  WaitUntil([&] {
    contact.Renew(kGains, Vec6::Zero());
    return contact.status().num_solved > 300 && driver.num_pushes() > 50;
  });
  CHECK(IsNear(contact.tool().q_WT[6], kRest, 1e-6));
  CHECK(servo.status().num_not_finite == 0);
  CHECK(contact.status().num_refused == 0);
  contact.Close();
  contact.Close();
  CHECK(!contact.status().is_running);
  CHECK(servo.status().is_running);
}

// A loop that stalls is a loop that stalls, however much is solved meanwhile.
void AStalledLoopIsReleased() {
  Driver driver;
  driver.MoveTo(kRest - 5e-3);
  UdpServoOptions options = Patient();
  options.times.hold = 0.3;
  UdpServo servo("127.0.0.1", driver.port(), options);
  ContactServo contact(&servo, MakeTool(5e-4));
  WaitUntil([&] {
    contact.Renew(kGains, Vec6::Zero());
    return servo.status().scale > 0.5;
  });
  const std::int64_t before = contact.status().num_solved;
  WaitUntil([&] { return servo.status().scale == 0; });
  CHECK(contact.status().num_solved > before);
}

// A program may let the force set in.
void NoMoreIsShownThanTheShare() {
  Driver driver;
  driver.MoveTo(kRest - 5e-3);
  UdpServo servo("127.0.0.1", driver.port(), Patient());
  ContactServo contact(&servo, MakeTool(5e-4));
  contact.SetShare(0);
  WaitUntil([&] {
    contact.Renew(kGains, Vec6::Zero());
    return contact.status().num_solved > 100 && servo.status().scale == 1;
  });
  CHECK(driver.num_pushes() == 0);
  contact.SetShare(0.5);
  WaitUntil([&] {
    contact.Renew(kGains, Vec6::Zero());
    return driver.num_pushes() > 50;
  });
}

// Each period is overrun: it is counted, and the servo answers all the same.
void OverrunPeriodsAreCounted() {
  Driver driver;
  UdpServo servo("127.0.0.1", driver.port(), Patient());
  ContactServo contact(&servo, MakeTool(1e-8));
  WaitUntil([&] {
    contact.Renew(kGains, Vec6::Zero());
    return contact.status().num_late > 100 && driver.num_pushes() > 50;
  });
}

void EndsWhereNobodyListens() {
  UdpServo servo("127.0.0.1", 9, Patient());
  ContactServo contact(&servo, MakeTool(5e-4));
  contact.Renew(kGains, Vec6::Zero());
  std::this_thread::sleep_for(std::chrono::milliseconds(5));
  CHECK(contact.status().num_solved == 0);  // there is no handle
}

}  // namespace
}  // namespace drake_haptics

int main() {
  drake_haptics::TheToolRestsOnThePlate();
  drake_haptics::AStalledLoopIsReleased();
  drake_haptics::NoMoreIsShownThanTheShare();
  drake_haptics::OverrunPeriodsAreCounted();
  drake_haptics::EndsWhereNobodyListens();
  return drake_haptics::FailedChecks() > 0;
}
