// The run-up of a solitary wave of 0.019 of the depth on a beach of 1:19.85, by the nonlinear theory of Synolakis
// (1987): some points of the profiles and gauges of NTHMP benchmark 1. Lengths in depths, times in sqrt(depth / g); x
// from the still shore, out to sea.
#pragma once

#include <array>
#include <limits>

namespace spindrift::study::canonical {

/// There is no water.
inline constexpr double kDry = std::numeric_limits<double>::quiet_NaN();

inline constexpr std::array<double, 16> kPlaces = {-1.5, -1, -0.5, 0, 0.5, 1, 2, 3, 4, 5, 6, 8, 10, 13, 16, 19};

struct Profile {
  double time;
  std::array<double, kPlaces.size()> level;
};
// clang-format off
inline constexpr std::array<Profile, 8> kProfiles = {{
    {35, {kDry, kDry, kDry, 0.00268, 0.00446, 0.00674, 0.01279, 0.01958, 0.02462, 0.02677, 0.02652, 0.0222, 0.01654, 0.00982, 0.00605, 0.00417}},
    {40, {kDry, kDry, kDry, 0.01072, 0.01735, 0.02349, 0.03015, 0.03081, 0.02849, 0.02494, 0.02107, 0.01424, 0.00952, 0.00573, 0.00407, 0.00331}},
    {45, {kDry, kDry, 0.03421, 0.03875, 0.0392, 0.03788, 0.03294, 0.02711, 0.02161, 0.01695, 0.01329, 0.00854, 0.00607, 0.00435, 0.0036, 0.00321}},
    {50, {kDry, 0.06427, 0.05594, 0.04872, 0.04227, 0.03649, 0.02682, 0.01961, 0.01455, 0.01115, 0.0089, 0.00637, 0.00513, 0.0042, 0.00372, 0.00341}},
    {55, {0.08198, 0.06837, 0.05641, 0.04614, 0.03753, 0.03052, 0.02063, 0.01478, 0.01134, 0.00923, 0.00787, 0.00626, 0.00536, 0.00457, 0.00409, 0.00376}},
    {60, {kDry, 0.05898, 0.04625, 0.03615, 0.02875, 0.02362, 0.0175, 0.01398, 0.01167, 0.01004, 0.00884, 0.00722, 0.00621, 0.00525, 0.00465, 0.00424}},
    {65, {kDry, kDry, kDry, 0.00889, 0.01017, 0.01399, 0.01616, 0.01541, 0.01395, 0.01245, 0.01112, 0.00905, 0.00764, 0.00628, 0.00544, 0.00488}},
    {70, {kDry, kDry, kDry, kDry, kDry, -0.02133, 0.0076, 0.01397, 0.01534, 0.01498, 0.014, 0.01174, 0.00983, 0.00785, 0.0066, 0.00578}}
}};
// clang-format on

/// Times of the samples of the gauges.
inline constexpr double kFirstTime = 20.0;
inline constexpr double kInterval = 5.0;

struct Gauge {
  double place;
  std::array<double, 21> level;
};
// clang-format off
inline constexpr std::array<Gauge, 2> kGauges = {{
    {0.25, {0.00009, 0.0003, 0.001, 0.0035, 0.01397, 0.03928, 0.04541, 0.04163, 0.03212, 0.00829, kDry, kDry, kDry, -0.00941, -0.00625, -0.00415, -0.00265, -0.00147, -0.00044, 0.00054, 0.00162}},
    {9.95, {0.00802, 0.01885, 0.02324, 0.01668, 0.00961, 0.00611, 0.00515, 0.00537, 0.00623, 0.00767, 0.00987, 0.01271, 0.01401, 0.00606, -0.00822, -0.01012, -0.00691, -0.00377, -0.00173, -0.00073, -0.00026}}
}};
// clang-format on

}  // namespace spindrift::study::canonical
