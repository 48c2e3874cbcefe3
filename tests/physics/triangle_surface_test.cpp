// Vertices at one place.
#include "physics/triangle_surface.hpp"

#include <catch2/catch.hpp>

using namespace kenaf::physics;

TEST_CASE("Vertices have one number if and only if they are at exactly the same place") {
  const std::vector<Eigen::Vector3d> vertices{{1, 2, 3},    {0, 0, 0}, {1, 2, 3}, {1, 2, 3.0000000001},
                                              {-0.0, 0, 0}, {1, 2, 3}};
  const std::vector<std::uint32_t> place = places_of(vertices);
  REQUIRE(place.size() == vertices.size());
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    CHECK(vertices[place[i]] == vertices[i]);
    for (std::size_t k = 0; k < vertices.size(); ++k) CHECK((place[i] == place[k]) == (vertices[i] == vertices[k]));
  }
  CHECK(places_of({}).empty());
}
