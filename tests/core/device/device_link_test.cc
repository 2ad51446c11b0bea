// Which states of a driver count, in what order, and which are missed.
#include "device/device_link.h"

#include <algorithm>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include "check.h"
#include "device/lateness_histogram.h"
#include "drake_haptics/wire.h"

namespace drake_haptics {
namespace {

using Arrival = SequenceWindow::Arrival;

// Against a plain list of what came, over a shuffled series with losses and
// duplicates, across the wrap of the numbers.
void WindowAgreesWithAList() {
  std::mt19937 random(1);
  for (int trial = 0; trial < 50; ++trial) {
    const std::uint32_t start = 0u - 200u + random() % 300;
    std::vector<std::pair<int, int>> on_the_way;  // when, what
    for (int i = 0; i < 400; ++i) {
      const int copies = random() % 10 == 0 ? 0 : random() % 10 == 1 ? 2 : 1;
      for (int copy = 0; copy < copies; ++copy) {
        on_the_way.emplace_back(i + random() % 16, i);
      }
    }
    std::sort(on_the_way.begin(), on_the_way.end());
    const int first = on_the_way[0].second;
    SequenceWindow window;
    std::set<int> came;
    int newest = -1, num_late = 0, num_duplicate = 0;
    for (const auto& [when, i] : on_the_way) {
      const Arrival arrival = window.Accept(start + i);
      if (i > newest) {
        CHECK(arrival == Arrival::kNewest);
        newest = i;
      } else if (i < first || came.count(i)) {
        // What is before the first was never expected.
        CHECK(arrival == Arrival::kDuplicate);
        ++num_duplicate;
      } else {
        CHECK(arrival == Arrival::kLate);
        ++num_late;
      }
      came.insert(i);
    }
    const auto expected = std::distance(came.lower_bound(first), came.end());
    CHECK(window.num_lost() == newest - first + 1 - expected);
    CHECK(window.num_late() == num_late);
    CHECK(window.num_duplicate() == num_duplicate);
  }
}

void FarAheadAndFarBehind() {
  SequenceWindow window;
  window.Accept(5);
  CHECK(window.Accept(5 + 1000000) == Arrival::kNewest);
  CHECK(window.num_lost() == 999999);
  CHECK(window.Accept(6) == Arrival::kDuplicate);
  window.Restart();
  CHECK(window.Accept(6) == Arrival::kNewest);
  CHECK(window.num_lost() == 999999);
}

std::vector<unsigned char> MakeState(std::uint32_t sequence, std::uint8_t gate,
                                     std::uint32_t boot = 1) {
  dh_state state{};
  state.X_BH[0] = 1;
  state.sequence = sequence;
  state.boot = boot;
  state.gate = gate;
  state.fault = gate == DH_FAULT ? DH_FAULT_OVERSPEED : DH_FAULT_NONE;
  std::vector<unsigned char> packet(DH_STATE_SIZE);
  dh_pack_state(&state, packet.data());
  return packet;
}

// Random lives of a driver and its host: what must hold after every event.
void EnablesOnlyWhatIsIdleAndWanted() {
  std::mt19937 random(2);
  int num_active = 0, num_latched = 0;
  for (int trial = 0; trial < 300; ++trial) {
    DeviceLink link(0.05);
    double now = 0;
    std::uint32_t sequence = 0, boot = 1;
    bool asked = false, was_active = false;
    for (int i = 0; i < 60; ++i) {
      const int event = random() % 12;
      bool recovered = false, idle_seen = false;
      if (event < 7) {
        if (event == 0) ++boot;
        const auto gate = static_cast<std::uint8_t>(event == 1     ? DH_FAULT
                                                    : random() % 2 ? DH_IDLE
                                                                   : DH_ACTIVE);
        idle_seen = gate == DH_IDLE;
        CHECK(link.Take(MakeState(++sequence, gate, boot), now));
      } else if (event == 7) {
        link.RequestWrench();
        asked = true;
      } else if (event == 8) {
        now += 0.06;
        link.Tick(now);
        CHECK(!link.IsHeard());
        CHECK(!link.IsActive());
      } else if (event == 9) {
        recovered = true;
        link.Recover();
      } else {
        now += 0.001;
        link.Tick(now);
      }
      if (link.IsActive()) {
        CHECK(asked && link.IsHeard() && link.IsEnabling());
        CHECK(link.state().gate != DH_FAULT);
        if (!was_active) {
          CHECK(idle_seen || recovered || event == 7 || event > 9);
        }
      } else if (was_active) {
        CHECK(link.state().gate == DH_FAULT);
        CHECK(link.state().fault != DH_FAULT_NONE);
        ++num_latched;
      }
      num_active += link.IsActive();
      was_active = link.IsActive();
    }
  }
  CHECK(num_active > 1000 && num_latched > 100);
}

void LatenessIsAgainstThePromptestOfLate() {
  AnswerLateness lateness;
  CHECK(lateness.Measure(100, 3) == 0);
  CHECK(std::abs(lateness.Measure(101, 4.5) - 0.5) < 1e-9);
  CHECK(lateness.Measure(102, 4.9) == 0);
  // The clocks drift by 0.1 ms/s; that is not taken for lateness for ever.
  double worst = 0;
  for (int i = 0; i < 1000; ++i) {
    worst = std::max(worst, lateness.Measure(103 + i, 6 + 1.0001 * i));
  }
  CHECK(worst < 0.11 + 20 * 1.1e-4);
  CHECK(lateness.Measure(1103, 6 + 1000.1) < 20 * 1.1e-4);
}

void HistogramIsWithinAFifth() {
  LatenessHistogram histogram;
  CHECK(histogram.Quantile(0.5) == 0);
  std::vector<double> values;
  std::mt19937 random(3);
  std::lognormal_distribution<double> distribution(-7, 2);
  for (int i = 0; i < 20000; ++i) {
    values.push_back(std::clamp(distribution(random), 2e-6, 9.0));
    histogram.Record(values.back());
  }
  std::sort(values.begin(), values.end());
  for (const double part : {0.5, 0.99, 0.999}) {
    const double truth = values[static_cast<std::size_t>(part * 20000) - 1];
    const double answer = histogram.Quantile(part);
    CHECK(answer >= truth && answer <= 1.2 * truth);
  }
  histogram.Record(-1);
  histogram.Record(1e9);
}

}  // namespace
}  // namespace drake_haptics

int main() {
  drake_haptics::WindowAgreesWithAList();
  drake_haptics::FarAheadAndFarBehind();
  drake_haptics::EnablesOnlyWhatIsIdleAndWanted();
  drake_haptics::LatenessIsAgainstThePromptestOfLate();
  drake_haptics::HistogramIsWithinAFifth();
  return drake_haptics::FailedChecks() > 0;
}
