#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "bind/bind.h"
#include "tool/energy_ledger.h"
#include "tool/stored_energy.h"

namespace nb = nanobind;

namespace drake_haptics {
namespace {

// The ledger of a loop whose sources have names.
struct NamedLedger {
  EnergyLedger ledger;
  std::vector<std::string> sources;
};

void RequireDistinct(const std::vector<std::string>& sources) {
  std::set<std::string> names{"device", "display", "coupling", "tool"};
  for (const std::string& name : sources) {
    if (!names.insert(name).second) {
      throw std::invalid_argument("there are two accounts of the name " + name);
    }
  }
}

void BindAccount(nb::module_& m) {
  nb::class_<EnergyAccount>(
      m, "EnergyAccount",
      "Energy account of one part of a haptic loop, J. Energy that went in and "
      "neither came out nor is stored is lost; a passive part never regains "
      "lost energy.")
      .def_prop_ro("in_J", &EnergyAccount::in,
                   "Energy that went into the part, through all its ports.")
      .def_prop_ro("out_J", &EnergyAccount::out, "Energy that came out.")
      .def_prop_ro("stored_J", &EnergyAccount::stored,
                   "Energy that the part stores.")
      .def_prop_ro("lost_J", &EnergyAccount::lost,
                   "in − out − (stored − stored at the start).")
      .def_prop_ro("damped_J", &EnergyAccount::damped,
                   "Part of `lost_J` that dampers took.")
      .def_prop_ro("created_J", &EnergyAccount::created,
                   "Energy that the part made: the largest fall of `lost_J` "
                   "from any earlier value.")
      .def_prop_ro("bound_J", &EnergyAccount::bound,
                   "Energy that the sampling of its force explains over the "
                   "same stretch of time.")
      .def_prop_ro("beyond_J", &EnergyAccount::beyond,
                   "Largest energy made over a stretch of time, less the "
                   "energy that sampling explains there.");
}

void BindLedger(nb::module_& m) {
  nb::class_<NamedLedger>(
      m, "EnergyLedger",
      "Books, tick by tick, the energy that goes through each part of a haptic "
      "loop: hand, display, coupling, tool and each source of wrench on the "
      "tool (energy_ledger.h). Mutable.")
      .def(
          "__init__",
          [](NamedLedger* self, const ToolInertia& dynamics,
             const CouplingGains& gains, const PoseVector& q_HT,
             double period_s, std::vector<std::string> sources) {
            RequireDistinct(sources);
            EnergyLedger ledger(dynamics, gains, q_HT, period_s,
                                sources.size());
            new (self) NamedLedger{std::move(ledger), std::move(sources)};
          },
          nb::arg("dynamics"), nb::arg("gains"), nb::arg("q_HT"),
          nb::arg("period_s"), nb::arg("sources"),
          "Args:\n"
          "    dynamics: inertia of the tool.\n"
          "    gains: gains of the coupling.\n"
          "    q_HT: (7,) pose of the tool in the handle at which its spring "
          "rests.\n"
          "    period_s: duration of a tick, s.\n"
          "    sources: names of the other sources of wrench on the tool.\n\n"
          "Raises:\n"
          "    ValueError: the tick is not above 0 s, or a name occurs twice "
          "or is that of another account.")
      .def(
          "begin_again",
          [](NamedLedger& self, const CouplingGains& gains) {
            self.ledger.BeginAgain(gains);
          },
          nb::arg("gains"),
          "Goes on after a change of gains, of the coupling or of a source. "
          "The tick up to the next `add` is left out of the accounts, and so "
          "is the energy that the change puts into springs or takes out.\n\n"
          "Args:\n"
          "    gains: gains of the coupling from now on.")
      .def(
          "add",
          [](NamedLedger& self, const ToolStateVector& tool_state,
             const PoseVector& q_WH, const Vec6& F_Ho_W_rendered,
             const WrenchModelVector& coupling,
             const std::vector<WrenchModelVector>& wrench_models,
             const std::vector<double>& stored) {
            if (wrench_models.size() != stored.size()) {
              throw std::invalid_argument(
                  "wrench_models and stored_J must have one value per source");
            }
            LoopReading reading{ToToolState(tool_state),
                                q_WH,
                                F_Ho_W_rendered,
                                ToWrenchModel(coupling),
                                {}};
            for (std::size_t i = 0; i < stored.size(); ++i) {
              reading.sources.push_back(
                  {ToWrenchModel<double>(wrench_models[i]), stored[i]});
            }
            self.ledger.Add(reading);
          },
          nb::arg("tool_state"), nb::arg("q_WH"), nb::arg("F_Ho_W_rendered"),
          nb::arg("coupling"), nb::arg("wrench_models"), nb::arg("stored_J"),
          "Books the tick between the last call and this one; the first call "
          "only sets the stored energies. All values are of one instant, after "
          "a step of the tool and before the next. A tick with an energy that "
          "is not finite is left out.\n\n"
          "Args:\n"
          "    tool_state: (13,) = [pose (7), m; spatial velocity (6), rad/s "
          "and m/s].\n"
          "    q_WH: (7,) pose of the handle.\n"
          "    F_Ho_W_rendered: (6,) wrench that was held on the handle up to "
          "now, at Ho in W, N·m and N.\n"
          "    coupling: (78,) wrench model of the coupling on the tool.\n"
          "    wrench_models: (78,) wrench model of each source.\n"
          "    stored_J: elastic or potential energy of each source.\n\n"
          "Raises:\n"
          "    ValueError: a source has no reading.")
      .def_prop_ro(
          "accounts",
          [](const NamedLedger& self) {
            const EnergyLedger::Accounts& accounts = self.ledger.accounts();
            nb::dict by_name;
            by_name["device"] = nb::cast(accounts.device);
            by_name["display"] = nb::cast(accounts.display);
            by_name["coupling"] = nb::cast(accounts.coupling);
            by_name["tool"] = nb::cast(accounts.tool);
            for (std::size_t i = 0; i < self.sources.size(); ++i) {
              by_name[self.sources[i].c_str()] = nb::cast(accounts.sources[i]);
            }
            return by_name;
          },
          nb::sig("def accounts(self) -> dict[str, EnergyAccount]"),
          "`EnergyAccount` of each part by its name, as it stands now: "
          "`device`, the whole loop as the hand feels it at its port; "
          "`display`, `coupling`, `tool`, and each source.");
}

void BindStoredEnergy(nb::module_& m) {
  m.def("contact_energy", &ContactEnergy, nb::arg("clusters"),
        nb::arg("stiffness"), nb::arg("tolerance"),
        "Energy that contacts store, J: half of each elastic force times its "
        "depth below the tolerance.\n\n"
        "Args:\n"
        "    clusters: `ClusterSet`.\n"
        "    stiffness: stiffness of each object, N/m.\n"
        "    tolerance: distance below which contacts push, m.\n\n"
        "Raises:\n"
        "    IndexError: a cluster names an object without a stiffness.");
  m.def("weight_energy", &WeightEnergy, nb::arg("q_WT"), nb::arg("p_TTcm"),
        nb::arg("weight_W"),
        "Potential energy of the tool's weight, J, zero with its center of "
        "mass at the world's origin.\n\n"
        "Args:\n"
        "    q_WT: (7,) pose of the tool.\n"
        "    p_TTcm: (3,) center of mass in the tool's frame, m.\n"
        "    weight_W: (3,) mass times gravity, N.");
}

}  // namespace

void BindEnergy(nb::module_& m) {
  BindAccount(m);
  BindLedger(m);
  BindStoredEnergy(m);
}

}  // namespace drake_haptics
