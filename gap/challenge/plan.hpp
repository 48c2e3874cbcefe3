// What the cases of a challenge are: which effects are hidden in them, how large, in which manoeuvres, and how the
// "real" side differs from the model besides, so that a fit is no tautology.
//
// There are two challenges. In the exact one the model with the hidden effects is right but for contacts and noise. In
// the imperfect one it never is, as with a real robot: every number of the description is a little off, a background to
// what is hidden. In those of another engine that engine moves the body besides, so that contacts are others, too.
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
// In a case's folder, the dataset of the robot as it was before.
inline constexpr const char* kBeforeFolder = "before";

enum class ChallengeKind { exact, imperfect, mujoco, ode };
std::string_view kind_name(ChallengeKind kind);
ChallengeKind challenge_kind_of(std::string_view name);  // throws std::invalid_argument
bool is_imperfect(ChallengeKind kind);
// Which other engine moves the "real" bodies (rollout/engines/body_in_engine.hpp); empty: none.
std::string_view engine_of(ChallengeKind kind);

enum class Stratum {
  none,             // nothing hidden but the background, where there is one
  single,           // one effect of the catalogue
  pair,             // two
  withheld,         // one, and the diagnosis has a catalogue without it
  foreign,          // something that the catalogue never had
  withheld_number,  // one number of the description, and the diagnosis does not search for it
  baseline,         // one effect, or nothing, since runs of before that the diagnosis has as well
};
std::string_view stratum_name(Stratum stratum);
bool is_outside(Stratum stratum);           // withheld or foreign: the diagnosis' catalogue does not have it
Stratum stratum_of(std::string_view name);  // throws std::invalid_argument

// How much of the squared gap an effect explains in one stage.
struct StageShare {
  std::string stage;  // "command to drive"
  double share = 0;
};

struct HiddenEffect {
  std::string effect, parameter;
  double floors = 0;                 // size: how large the gap by it alone is, in noise floors, over all channels
  double value = 0;                  // that makes it so large; known once the case is made
  double times_background = 0;       // size beside the background's, of the imperfect challenge
  std::vector<StageShare> shares{};  // of the stages that show it; likewise, known once the case is made
};

struct HiddenNumber {
  std::string key;  // "drive.max_force_n"; empty: none is hidden
  double value = 0;
  double floors = 0, times_background = 0;  // as of an effect
};

// The effect of a diagnosis' catalogue that looks most like what is hidden and not in it.
struct LookAlike {
  std::string effect;     // as reports name it
  double angle_deg = 90;  // between what the two shift, 0 (the same) to 90 (nothing in common)
};

struct CasePlan {
  std::string name;  // "case-017"
  Stratum stratum = Stratum::none;
  std::vector<HiddenEffect> effects;
  std::string foreign;  // one of foreign_effects(), or empty
  double foreign_floors = 0, foreign_amount = 0, foreign_times_background = 0;
  HiddenNumber number;                  // of the description
  LookAlike look_alike;                 // of what is withheld or foreign; known once the case is made
  Background background;                // of the imperfect challenge; else no numbers
  std::vector<std::string> manoeuvres;  // of the dataset
  std::vector<double> longest_s;        // after which each of its runs is cut off; empty: none is
  std::string unseen;                   // another one, to try the diagnosis' robot.toml on
  int repeats = 2;
  std::string engine;                          // that moves the "real" body; empty: Kenaf's own
  physics::PhysicsSettings physics;            // of the "real" side
  double noise_scale = 1, noise_memory_s = 0;  // of the pose; 0: white
  double count_scale = 0;  // columns are whole counts of so many times their resolution; 0: they are not
  std::uint64_t seed = 0;

  bool is_imperfect() const { return !background.numbers.empty(); }
  // Else by noise floors: also where runs of before have the same background, so that it cancels.
  bool is_sized_by_background() const { return is_imperfect() && stratum != Stratum::baseline; }
};

// Of the catalogue, which must have it: a plan hides nothing else, and a key that is read is checked for it.
const physics::EffectParameter& parameter_of(const HiddenEffect& hidden);

// The value that a model with the simulator's own contacts needs for the same: the give of the ground and its damping
// multiply those of the "real" side's contacts, which are others.
double value_in_model(const CasePlan& plan, const HiddenEffect& hidden);

// The furthest value from neutral that a case may hide: within the range of a diagnosis' candidate on the "real" side
// and in the model, for a diagnosis cannot find what is beyond.
double furthest_value(const CasePlan& plan, const physics::EffectParameter& parameter, bool upward);
// Likewise of the hidden number of the description; with it the robot of the background is one that its description
// allows.
double furthest_value_of_number(const CasePlan& plan, bool upward);

// Shares of strata, and sizes, are those of docs/gap-challenge.md. Of singles and withheld ones together each effect of
// the catalogue has its turn; pairs and foreign ones are drawn by chance. In an order that says nothing.
std::vector<CasePlan> plan_challenge(std::size_t cases, std::uint64_t seed, ChallengeKind kind = ChallengeKind::exact);

// Manoeuvres of a case and when they are cut off, for when an effect does not show in those it was given: all that this
// kind of case may have, its own first.
struct CaseRuns {
  std::vector<std::string> manoeuvres;
  std::vector<double> longest_s;
};
std::vector<CaseRuns> runs_to_choose_from(const CasePlan& plan);

struct ForeignEffect {
  std::string_view name, summary;
};
std::vector<ForeignEffect> foreign_effects();

}  // namespace kenaf::gap::challenge
