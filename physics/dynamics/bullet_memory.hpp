// What happens when Bullet finds no memory. By itself it goes on with a null pointer, and the process dies.
#pragma once

namespace kenaf::physics {

// From the first call on, Bullet throws std::bad_alloc instead, in all threads of this process. Bullet's functions then
// give the basic guarantee only: whoever adds a body must remove it again after a throw. Thread safety: any thread.
void have_bullet_throw();

}  // namespace kenaf::physics
