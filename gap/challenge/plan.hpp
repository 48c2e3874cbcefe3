// Plans the cases of a challenge: which effects are hidden in them, how large, in which manoeuvres, and how the "real"
// side differs from the model in other ways, so that a fit is not a tautology.
//
// There are two challenges. In the exact one the model with the hidden effects is right except for contacts and noise.
// In the imperfect one it never is, as with a real robot: every number of the description is a little off, as a
// background to the hidden effects. With another engine, that engine also moves the body, so that contacts differ, too.
//
// Thread safety: pure functions; deterministic for a seed.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "gap/challenge/background.hpp"
#include "physics/effects.hpp"
#include "physics/world.hpp"

namespace kenaf::gap::challenge {

inline constexpr const char* kChallengedRobot = "kenaf";
// Subfolder of a case with the dataset of the robot before the change.
inline constexpr const char* kBeforeFolder = "before";

enum class ChallengeKind { exact, imperfect, mujoco, ode };
std::string_view kind_name(ChallengeKind kind);
ChallengeKind challenge_kind_of(std::string_view name);  // throws std::invalid_argument
bool is_imperfect(ChallengeKind kind);
// Returns the other engine that moves the "real" bodies (rollout/engines/body_in_engine.hpp); empty: none.
std::string_view engine_of(ChallengeKind kind);

enum class Stratum {
  none,             // nothing hidden except the background, if there is one
  single,           // one effect of the catalogue
  pair,             // two effects
  withheld,         // one effect, which the catalogue of the diagnosis lacks
  foreign,          // a deviation that the catalogue never had
  withheld_number,  // one number of the description, for which the diagnosis does not search
  baseline,         // one effect, or nothing, since earlier runs that the diagnosis also has
};
std::string_view stratum_name(Stratum stratum);
bool is_outside(Stratum stratum);           // withheld or foreign: the catalogue of the diagnosis lacks it
Stratum stratum_of(std::string_view name);  // throws std::invalid_argument

// Share of the squared gap that an effect explains in one stage.
struct StageShare {
  std::string stage;  // "command to drive"
  double share = 0;
};

struct HiddenEffect {
  std::string effect, parameter;
  double floors = 0;                 // size: the gap that it adds to all others, over all channels, in noise floors
  double value = 0;                  // that gives this size; known once the case is made
  double times_background = 0;       // size relative to the background's, in the imperfect challenge
  std::vector<StageShare> shares{};  // in the stages that show it; known once the case is made
};

struct HiddenNumber {
  std::string key;  // "drive.max_force_n"; empty: none is hidden
  double value = 0;
  double floors = 0, times_background = 0;  // as in HiddenEffect
};

// The effect in the catalogue of a diagnosis that looks most like the hidden one outside it.
struct LookAlike {
  std::string effect;     // as reports name it
  double angle_deg = 90;  // between the shifts of the two, 0 (the same) to 90 (nothing in common)
};

struct CasePlan {
  std::string name;  // "case-017"
  Stratum stratum = Stratum::none;
  std::vector<HiddenEffect> effects;
  std::string foreign;  // one of foreign_effects(), or empty
  double foreign_floors = 0, foreign_amount = 0, foreign_times_background = 0;
  HiddenNumber number;                  // of the description
  LookAlike look_alike;                 // for withheld and foreign strata; known once the case is made
  Background background;                // of the imperfect challenge; otherwise without numbers
  std::vector<std::string> manoeuvres;  // of the dataset
  std::vector<double> longest_s;        // times after which its runs are cut off; empty: none is
  std::string unseen;                   // another manoeuvre, to try the diagnosis' robot.toml on
  int repeats = 2;
  std::string engine;                          // moves the "real" body; empty: Kenaf's own
  physics::PhysicsSettings physics;            // of the "real" side
  double noise_scale = 1, noise_memory_s = 0;  // of the pose; 0: white
  double count_scale = 0;  // columns are whole counts of this many times their resolution; 0: not quantized
  std::uint64_t seed = 0;

  bool is_imperfect() const { return !background.numbers.empty(); }
  // Otherwise sized by noise floors, also if earlier runs have the same background, so that it cancels.
  bool is_sized_by_background() const { return is_imperfect() && stratum != Stratum::baseline; }
};

// Returns the parameter in the catalogue, which must have it: plans hide nothing else, and keys are checked for it.
const physics::EffectParameter& parameter_of(const HiddenEffect& hidden);

// Returns the value that has the same effect in a model with the simulator's own contacts: ground compliance and
// damping scale the contacts of the "real" side, which differ from the model's. Ground that gives twice as much under
// contacts 1.25 times stiffer than the model's is a compliance of 1.6.
double value_in_model(const CasePlan& plan, const HiddenEffect& hidden);

// Returns the furthest value from neutral that a case may hide. It is within the range of a diagnosis' candidate both
// on the "real" side and in the model, because no diagnosis can find a value beyond.
double furthest_value(const CasePlan& plan, const physics::EffectParameter& parameter, bool upward);
// Likewise for the hidden number of the description; the robot with background and this value is a valid one.
double furthest_value_of_number(const CasePlan& plan, bool upward);

// Plans cases with the shares of strata and the sizes of docs/gap-challenge.md. Each effect of the catalogue has its
// turn among singles and withheld ones together; pairs and foreign ones are drawn by chance. The order is random.
std::vector<CasePlan> plan_challenge(std::size_t cases, std::uint64_t seed, ChallengeKind kind = ChallengeKind::exact);

// Manoeuvres of a case and when they are cut off.
struct CaseRuns {
  std::vector<std::string> manoeuvres;
  std::vector<double> longest_s;
};
// Returns all that this kind of case may have, its own first, in case an effect does not show in those.
std::vector<CaseRuns> runs_to_choose_from(const CasePlan& plan);

struct ForeignEffect {
  std::string_view name, summary;
};
std::vector<ForeignEffect> foreign_effects();

}  // namespace kenaf::gap::challenge
