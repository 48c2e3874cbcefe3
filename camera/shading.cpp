#include "camera/shading.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "camera/wide_vectors.hpp"

namespace kenaf::camera {

namespace {

struct Look {
  std::array<float, 3> rgb;
  float checks, lines;  // relative brightness added by them
  float edge = 0;       // relative darkness of edges
};

constexpr std::array<Look, kMaterialCount> kLooks{{
    {{168, 164, 152}, 0.13f, -0.22f},     // ground
    {{150, 158, 122}, 0.13f, -0.22f},     // terrain
    {{206, 178, 136}, 0, -0.20f, 0.55f},  // fixed_box
    {{186, 132, 92}, 0, -0.20f, 0.55f},   // loose_box
    {{236, 186, 40}, 0, 0, 0.35f},        // hull
    {{74, 74, 78}, 0.42f, 0},             // belt
    {{96, 98, 104}, 0, 0},                // track_side
    {{222, 96, 44}, 0, 0},                // front_flipper
    {{70, 112, 176}, 0, 0},               // rear_flipper
    {{158, 162, 168}, 0, 0},              // drum
}};
constexpr std::array<float, 3> kSunlight{0.66f, 0.63f, 0.57f};
constexpr std::array<float, 3> kSkylight{0.42f, 0.44f, 0.49f};  // on faces that look up
constexpr std::array<float, 3> kHorizon{206, 217, 226}, kZenith{96, 146, 206};
constexpr float kHaze_m = 60;  // depth of half fading
constexpr float kEdge_m = 0.012f;

constexpr int kChunk = 64;
using Numbers = std::array<float, kChunk>;
using Colours = std::array<std::array<int, kChunk>, 3>;

// Light without the sun: least from below, and a little more from the left and ahead, so that no two faces of a box
// look the same in the shade.
float skylight(const Eigen::Vector3f& normal_W) {
  return 0.82f + 0.16f * normal_W.z() + 0.07f * normal_W.x() + 0.04f * normal_W.y();
}

int level(float colour) {
  // NOLINTNEXTLINE(bugprone-incorrect-roundings): never negative, and for each pixel: no call
  return static_cast<int>(std::min(255.0f, std::max(0.0f, colour)) + 0.5f);
}

void write(const Colours& colours, int count, std::uint8_t* rgb) {
  for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i)
    for (std::size_t k = 0; k < 3; ++k) *rgb++ = static_cast<std::uint8_t>(colours[k][i]);
}

// The part of one row that shows one face.
struct Run {
  Run(const ScreenFace& f, PixelKey key, float v) : face(f), look(kLooks[static_cast<std::size_t>(f.material)]) {
    const auto row = [v](const Linear& linear) { return linear.at_0 + 0.5f * linear.per_u + v * linear.per_v; };
    q = row(f.nearness), s = row(f.s), t = row(f.t), facing = row(f.facing);
    const bool lit = (key & kShade) == 0;
    for (std::size_t k = 0; k < 3; ++k) {
      in_shade[k] = look.rgb[k] * kSkylight[k] * skylight(f.normal_W);
      by_sun[k] = lit ? look.rgb[k] * kSunlight[k] : 0;
    }
  }
  const ScreenFace& face;
  const Look& look;
  float q, s, t, facing;  // at the centre of the row's first pixel
  std::array<float, 3> in_shade, by_sun;
};

// Values at the pixels of a chunk of a run.
struct Samples {
  Numbers s, t, s_wide, t_wide;  // texture coordinates, and a pixel's footprint in them
  Numbers facing, haze, bright;
  std::array<int, kChunk> s_phase, t_phase, s_level, t_level;
};

void sample(const Run& run, int first, int count, Samples& out) {
  // A texture coordinate is a ratio S / q of linear functions, so its footprint is the sum of
  // |dS/du - s dq/du| / q and the same by v. Haze is 1 / (1 + (kHaze_m / depth)^2).
  const ScreenFace& f = run.face;
  for (int i = 0; i < count; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const auto u = static_cast<float>(first + i);
    const float q = run.q + u * f.nearness.per_u;
    const float depth = 1 / q;
    const float s = (run.s + u * f.s.per_u) * depth, t = (run.t + u * f.t.per_u) * depth;
    out.s[k] = s;
    out.t[k] = t;
    out.s_wide[k] =
        (std::abs(f.s.per_u - s * f.nearness.per_u) + std::abs(f.s.per_v - s * f.nearness.per_v)) * std::abs(depth);
    out.t_wide[k] =
        (std::abs(f.t.per_u - t * f.nearness.per_u) + std::abs(f.t.per_v - t * f.nearness.per_v)) * std::abs(depth);
    out.facing[k] = std::max(0.0f, (run.facing + u * f.facing.per_u) * depth);
    out.haze[k] = 1 / (1 + q * q * (kHaze_m * kHaze_m));
    out.bright[k] = 1;
  }
}

// Four levels to an octave: a float's exponent and the two highest bits of its mantissa.
int level_of(float footprint) {
  constexpr int kFirst = (127 + Pattern::kSmallest) * 4;
  return std::min(Pattern::kLevels - 1, std::max(0, (std::bit_cast<int>(footprint) >> 21) - kFirst));
}

int phase_of(float coordinate) {
  constexpr float kFar = 4096;  // periods: keeps the number positive wherever a pattern is still visible
  return static_cast<int>((std::min(kFar, std::max(-kFar, coordinate)) + kFar) * Pattern::kPhases) &
         (Pattern::kPhases - 1);
}

void add_pattern(const Look& look, const Pattern& pattern, int count, Samples& samples) {
  for (int i = 0; i < count; ++i) {
    const auto k = static_cast<std::size_t>(i);
    samples.s_phase[k] = phase_of(samples.s[k]);
    samples.t_phase[k] = phase_of(samples.t[k]);
    samples.s_level[k] = level_of(samples.s_wide[k]);
    samples.t_level[k] = level_of(samples.t_wide[k]);
  }
  const float checks = look.checks / (127 * 127), lines = look.lines / 127;
  for (int i = 0; i < count; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const Pattern::Value a = pattern.at(samples.s_level[k], samples.s_phase[k]);
    const Pattern::Value b = pattern.at(samples.t_level[k], samples.t_phase[k]);
    samples.bright[k] =
        1 + checks * static_cast<float>(a.wave * b.wave) + lines * static_cast<float>(std::max(a.line, b.line));
  }
}

// The share of a pixel that an edge at `half` covers.
float edge_cover(float coordinate, float wide, float half) {
  const float inside = half - std::abs(coordinate);
  return std::min(1.0f, std::max(0.0f, (kEdge_m - inside) / wide + 0.5f)) * std::min(1.0f, kEdge_m / wide);
}

void add_edges(const Run& run, int count, Samples& samples) {
  for (int i = 0; i < count; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const float cover = std::max(edge_cover(samples.s[k], samples.s_wide[k] + 1e-6f, run.face.half_s),
                                 edge_cover(samples.t[k], samples.t_wide[k] + 1e-6f, run.face.half_t));
    samples.bright[k] *= 1 - run.look.edge * cover;
  }
}

// Colour = (light in the shade + sunlight * facing) * texture, faded into the horizon; chunk by chunk.
KENAF_WIDE_VECTORS void shade_face(const Run& run, const Pattern& pattern, int first, int end, std::uint8_t* rgb) {
  Samples samples;
  Colours colours;
  for (; first < end; first += kChunk) {
    const int count = std::min(kChunk, end - first);
    const int whole = (count + 3) & ~3;  // rounded up to whole vectors: most runs are short
    sample(run, first, whole, samples);
    if (run.look.checks != 0 || run.look.lines != 0) add_pattern(run.look, pattern, whole, samples);
    if (run.face.half_s > 0) add_edges(run, whole, samples);
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t i = 0; i < static_cast<std::size_t>(whole); ++i) {
        const float colour = (run.in_shade[k] + run.by_sun[k] * samples.facing[i]) * samples.bright[i];
        colours[k][i] = level(colour + (kHorizon[k] - colour) * samples.haze[i]);
      }
    }
    write(colours, count, rgb + 3 * first);
  }
}

KENAF_WIDE_VECTORS void shade_sky(const RayBasis& basis, float v, int first, int end, std::uint8_t* rgb) {
  const Eigen::Vector3f row = (basis.at_0 + 0.5 * basis.per_u + v * basis.per_v).cast<float>();
  const Eigen::Vector3f per_u = basis.per_u.cast<float>();
  Colours colours;
  for (; first < end; first += kChunk) {
    const int count = std::min(kChunk, end - first);
    for (int i = 0; i < count; ++i) {
      const auto k = static_cast<std::size_t>(i);
      const auto u = static_cast<float>(first + i);
      const float x = row.x() + u * per_u.x(), y = row.y() + u * per_u.y(), z = row.z() + u * per_u.z();
      const float height = std::min(1.0f, std::max(0.0f, 1.6f * z / std::sqrt(x * x + y * y + z * z)));
      for (std::size_t c = 0; c < 3; ++c) colours[c][k] = level(kHorizon[c] + (kZenith[c] - kHorizon[c]) * height);
    }
    write(colours, count, rgb + 3 * first);
  }
}

}  // namespace

void Shading::shade(const View& view, const KeyPicture& keys, ScreenFaces& faces, Picture& out) const {
  const int width = view.lens.width, height = view.lens.height;
  out.width = width;
  out.height = height;
  out.rgb.resize(3 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  const RayBasis basis(view);
  for (int y = 0; y < height; ++y) {
    const PixelKey* row = keys.row(y);
    std::uint8_t* rgb = &out.rgb[3 * static_cast<std::size_t>(width) * static_cast<std::size_t>(y)];
    const float v = static_cast<float>(y) + 0.5f;
    // Runs of pixels with one key.
    for (int first = 0; first < width;) {
      const PixelKey key = row[first];
      int end = first + 1;
      while (end < width && row[end] == key) ++end;
      if (key == kNothing)
        shade_sky(basis, v, first, end, rgb);
      else
        shade_face(Run(faces.at(key & ~kShade), key, v), pattern_, first, end, rgb);
      first = end;
    }
  }
}

}  // namespace kenaf::camera
