#include "physics/body_effects.hpp"

namespace kenaf::physics {

// Bullet's equations of motion have a solution for any three moments above zero.
BodyDescription with_body_effects(BodyDescription body, const Effects& effects) {
  body.mass_kg *= effects.mass_scale;
  body.inertia_kgm2 *= effects.mass_scale;
  body.inertia_kgm2.x() *= effects.roll_inertia_scale;
  body.inertia_kgm2.y() *= effects.pitch_inertia_scale;
  body.inertia_kgm2.z() *= effects.yaw_inertia_scale;
  body.p_BBcm_m += Eigen::Vector3d(effects.com_forward_m, effects.com_left_m, effects.com_up_m);
  return body;
}

}  // namespace kenaf::physics
