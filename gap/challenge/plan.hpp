// What the cases of a challenge are: which effects are hidden in them, how large, in which manoeuvres, and how the "real"
// side differs from the model besides, so that a fit is no tautology.
// Thread safety: pure functions; deterministic for a seed.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "physics/effects.hpp"
#include "physics/world.hpp"

namespace kenaf::gap {

enum class Stratum {
  none,      // nothing hidden
  single,    // one effect of the catalogue
  pair,      // two
  withheld,  // one, and the diagnosis has a catalogue without it
  foreign,   // something that the catalogue never had
};
std::string_view stratum_name(Stratum stratum);
bool is_outside(Stratum stratum);         // withheld or foreign: the diagnosis' catalogue does not have it
Stratum stratum_of(std::string_view name);  // throws std::invalid_argument

struct HiddenEffect {
  std::string effect, parameter;
  double floors = 0;  // size: how large the gap by it alone is, in noise floors, over all channels
  double value = 0;   // that makes it so large; known once the case is made
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
  std::string foreign;                  // one of foreign_effects(), or empty
  double foreign_floors = 0, foreign_amount = 0;
  LookAlike look_alike;                 // of what is withheld or foreign; known once the case is made
  std::vector<std::string> manoeuvres;  // of the dataset
  std::string unseen;                   // another one, to try the diagnosis' robot.toml on
  int repeats = 2;
  physics::PhysicsSettings physics;     // of the "real" side
  double noise_scale = 1, noise_memory_s = 0;  // of the pose; 0: white
  std::uint64_t seed = 0;
};

// Of the catalogue, which must have it: a plan hides nothing else, and a key that is read is checked for it.
const physics::EffectParameter& parameter_of(const HiddenEffect& hidden);

// The value that a model with the simulator's own contacts needs for the same: the give of the ground and its damping
// multiply those of the "real" side's contacts, which are others.
double value_in_model(const CasePlan& plan, const HiddenEffect& hidden);

// The furthest value from neutral that a case may hide: within the parameter's range on the "real" side and in the
// model, for a diagnosis cannot find what is beyond.
double furthest_value(const CasePlan& plan, const physics::EffectParameter& parameter, bool upward);

// Nothing hidden in three of ten; of the rest each effect of the catalogue alone in turn, each withheld in turn, pairs
// and foreign ones by chance. In an order that says nothing.
std::vector<CasePlan> plan_challenge(std::size_t cases, std::uint64_t seed);

// Sets of manoeuvres that a case may have, for when an effect does not show in those it was given.
std::vector<std::vector<std::string>> manoeuvre_sets();

struct ForeignEffect {
  std::string_view name, summary;
};
std::vector<ForeignEffect> foreign_effects();

}  // namespace kenaf::gap
