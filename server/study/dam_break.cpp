// A column twice as high as long collapses (Martin & Moyce 1952): Z = front/a against T = t sqrt(2 g/a).
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include <fmt/format.h>

#include <spindrift/sim/water_sim.h>

#include "cases.h"
#include "particle_choices.h"
#include "ticks.h"

namespace spindrift::study {
namespace {

struct Point {
  double time;    ///< T of the paper
  double length;  ///< Z of the paper
};

constexpr std::array<Point, 15> kWide = {{{0.832, 1.217},
                                          {1.219, 1.474},
                                          {1.997, 2.292},
                                          {2.547, 2.995},
                                          {3.345, 4.134},
                                          {4.034, 4.944},
                                          {4.418, 5.881},
                                          {5.091, 6.980},
                                          {5.685, 7.945},
                                          {6.306, 8.966},
                                          {6.822, 9.986},
                                          {7.439, 10.963},
                                          {8.031, 11.977},
                                          {8.633, 13.005},
                                          {9.237, 13.970}}};
constexpr std::array<Point, 10> kNarrow = {{{0.849, 1.245},
                                            {1.212, 1.443},
                                            {1.602, 1.884},
                                            {2.283, 2.689},
                                            {2.950, 3.728},
                                            {3.598, 4.528},
                                            {3.905, 4.999},
                                            {4.592, 5.841},
                                            {4.961, 6.271},
                                            {5.316, 6.717}}};

/// Share of the water that counts as ahead of the front: single particles fly before the tongue.
constexpr double kAheadShare = 0.01;
constexpr double kFirstT = 1.0;
constexpr double kLastT = 9.0;

/// Viscosity [Pa s] between the values that fit the two series best. The experiments used columns of 5.7 and 2.9 cm of
/// real water on a floor whose friction is not modelled. Every kernel set and solver adds viscosity of its own (`--case
/// taylor-green`), Mueller's the least.
double viscosity(core::PressureSolver solver, core::KernelSet set) {
  if (solver == core::PressureSolver::kPositionBased) return 1.7;
  switch (set) {
    case core::KernelSet::kMuller:
      return 3.7;
    case core::KernelSet::kCubicSpline:
      return 2.4;
    case core::KernelSet::kWendlandC2:
      break;
  }
  return 2.2;
}

/// A column of 1 m x 2 m x 0.3 m with `layers` layers in a dry channel, long enough for T = 9. The channel is periodic
/// across.
core::Scene damScene(core::PressureSolver solver, core::KernelSet set, std::uint32_t layers) {
  core::Scene scene;
  scene.name = "dam";
  scene.tick_rate_hz = 120.0;
  scene.particles.emplace();
  core::ParticleScene& p = *scene.particles;
  p.layers_count = layers;
  const double spacing_m = 2.0 / layers;
  p.box_side_m = 16.0;
  p.box_width_m = 6 * spacing_m;
  p.count = layers * (layers / 2) * 6;
  p.fill_x_ratio = 1.0 / 16;
  p.headroom_m = 1.0;
  p.max_speed_mps = 12.0;
  p.sound_speed_mps = 60.0;
  p.viscosity_pas = viscosity(solver, set);
  p.jitter_ratio = 0.02;
  p.iterations_count = 4;
  p.solver = solver;
  p.kernel_set = set;
  p.boundary_x = core::Boundary::kWall;
  p.boundary_z = core::Boundary::kPeriodic;
  return scene;
}

/// Measured values of a collapsing column, one point per tick, over the column's length a.
struct Collapse {
  std::vector<Point> front;   ///< all but kAheadShare of the water is behind it
  std::vector<Point> tongue;  ///< leading edge of the water connected with the column's foot
  std::vector<Point> column;  ///< height of that water at the wall
};

/// The connected body of water: particles that reach each other through neighbours closer than the support radius,
/// starting at the one nearest to the foot of the wall.
class ConnectedWater {
 public:
  ConnectedWater(const std::vector<float>& position, const sim::ParticleLayout& layout)
      : position_(position), layout_(layout) {
    for (std::size_t i = 0; i < position.size() / 4; ++i) cells_[cellOf(i)].push_back(i);
    std::size_t foot = 0;
    const auto fromFoot = [&](std::size_t i) {
      return position[4 * i] - layout.min_m[0] + position[4 * i + 1] - layout.min_m[1];
    };
    for (std::size_t i = 1; i < position.size() / 4; ++i) {
      if (fromFoot(i) < fromFoot(foot)) foot = i;
    }
    grow(foot);
  }

  /// Distance of the farthest particle from the wall at the start of the box. [m]
  [[nodiscard]] double edge_m() const {
    double x_m = 0.0;
    for (const std::size_t i : members_) x_m = std::max(x_m, position_[4 * i] - layout_.min_m[0]);
    return x_m + 0.5 * layout_.spacing_m;
  }
  /// Height over the floor of the highest particle within a support radius of the wall. [m]
  [[nodiscard]] double columnHeight_m() const {
    double y_m = 0.0;
    for (const std::size_t i : members_) {
      if (position_[4 * i] < layout_.min_m[0] + layout_.support_radius_m)
        y_m = std::max(y_m, position_[4 * i + 1] + layout_.band_m);
    }
    return y_m + 0.5 * layout_.spacing_m;
  }

 private:
  using Cell = std::array<int, 2>;  ///< along x and up; the channel is a few particles wide

  [[nodiscard]] Cell cellOf(std::size_t i) const {
    return {static_cast<int>(std::floor((position_[4 * i] - layout_.min_m[0]) / layout_.support_radius_m)),
            static_cast<int>(std::floor((position_[4 * i + 1] - layout_.min_m[1]) / layout_.support_radius_m))};
  }
  [[nodiscard]] bool areNeighbours(std::size_t a, std::size_t b) const {
    double square_m2 = 0.0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      double d_m = position_[4 * a + axis] - position_[4 * b + axis];
      const double width_m = layout_.max_m[2] - layout_.min_m[2];
      if (axis == 2) d_m -= width_m * std::round(d_m / width_m);  // periodic across
      square_m2 += d_m * d_m;
    }
    return square_m2 < layout_.support_radius_m * layout_.support_radius_m;
  }
  void grow(std::size_t first) {
    std::vector<bool> is_member(position_.size() / 4, false);
    is_member[first] = true;
    members_ = {first};
    for (std::size_t next = 0; next < members_.size(); ++next) {
      const Cell at = cellOf(members_[next]);
      for (int dx = -1; dx <= 1; ++dx) {
        for (int dy = -1; dy <= 1; ++dy) {
          const auto found = cells_.find(Cell{at[0] + dx, at[1] + dy});
          if (found == cells_.end()) continue;
          for (const std::size_t i : found->second) {
            if (is_member[i] || !areNeighbours(members_[next], i)) continue;
            is_member[i] = true;
            members_.push_back(i);
          }
        }
      }
    }
  }

  const std::vector<float>& position_;
  const sim::ParticleLayout& layout_;
  std::map<Cell, std::vector<std::size_t>> cells_;
  std::vector<std::size_t> members_;
};

core::Result<Collapse> collapse(gpu::Context& ctx, const core::Scene& scene) {
  auto made = sim::WaterSim::create(ctx, scene);
  if (!made) return made.error();
  sim::WaterSim& water = **made;
  const sim::ParticleLayout& l = *water.derived().particles;
  const double a_m = 1.0;
  Collapse out{{{0.0, 1.0}}, {{0.0, 1.0}}, {{0.0, 2.0}}};
  while (out.front.back().time < kLastT + 0.1) {
    if (auto done = tick(water); !done) return done.error();
    const sim::StateCopy state = water.copyState();
    std::vector<float> x_m;
    for (std::size_t i = 0; i < state.position.size(); i += 4) x_m.push_back(state.position[i]);
    const auto ahead = std::max<std::ptrdiff_t>(std::lround(kAheadShare * static_cast<double>(x_m.size())), 1);
    std::nth_element(x_m.begin(), x_m.end() - ahead, x_m.end());
    const double front_m = *(x_m.end() - ahead) - l.min_m[0] + 0.5 * l.spacing_m;
    const ConnectedWater connected(state.position, l);
    const double T = water.time_s() * std::sqrt(2 * scene.gravity_mps2 / a_m);
    out.front.push_back({T, front_m / a_m});
    out.tongue.push_back({T, connected.edge_m() / a_m});
    out.column.push_back({T, connected.columnHeight_m() / a_m});
  }
  return out;
}

double at(const std::vector<Point>& series, double T) {
  const auto next = std::ranges::lower_bound(series, T, {}, &Point::time);
  if (next == series.begin()) return next->length;
  const auto before = next - 1;
  return std::lerp(before->length, next->length, (T - before->time) / (next->time - before->time));
}

void compare(const std::vector<Point>& computed, const auto& measured, const std::string& name,
             const std::string& series, std::vector<Row>& rows) {
  double squares = 0.0;
  double worst = 0.0;
  int count = 0;
  for (const Point& point : measured) {
    if (point.time < kFirstT || point.time > kLastT) continue;
    const double error = at(computed, point.time) / point.length - 1;
    squares += error * error;
    worst = std::max(worst, std::abs(error));
    ++count;
  }
  const std::string source = "Martin & Moyce 1952, " + series + ", T = 1 to 9";
  rows.push_back({name + ", " + series + ": front, root mean square", "%", 100 * std::sqrt(squares / count), 5.0,
                  Tolerance::kAtMost, 0.0, source});
  rows.push_back(
      {name + ", " + series + ": front, worst point", "%", 100 * worst, 10.0, Tolerance::kAtMost, 0.0, source});
}

/// For columns whose front is not well defined: prints the leading edge of the tongue, the front of 99 % of the water,
/// and the rest of the column.
void describe(const Collapse& computed, const std::string& name, std::vector<Row>& rows) {
  const auto report = [&](std::string what, double value) {
    rows.push_back({name + ": " + std::move(what), "", value, 0.0, Tolerance::kNone, 0.0, "reported only"});
  };
  double squares = 0.0;
  int count = 0;
  for (const Point& point : kWide) {
    if (point.time < kFirstT || point.time > kLastT) continue;
    squares += std::pow(at(computed.tongue, point.time) / point.length - 1, 2);
    ++count;
  }
  rows.push_back({name + ", a = 2.25 in: leading edge of the tongue, root mean square", "%",
                  100 * std::sqrt(squares / count), 0.0, Tolerance::kNone, 0.0,
                  "Martin & Moyce 1952, T = 1 to 9; the tolerance is the 99 % front's"});
  for (const double T : {2.0, 4.0, 6.0, 8.0}) {
    report(fmt::format("leading edge x/a at T = {}", T), at(computed.tongue, T));
    report(fmt::format("front of 99 % of the water x/a at T = {}", T), at(computed.front, T));
    report(fmt::format("height of the column y/a at T = {}", T), at(computed.column, T));
  }
}

Figure::Curve curveOf(const std::string& name, const auto& series) {
  Figure::Curve curve{name, {}};
  for (const Point& point : series) {
    if (point.time <= kLastT + 0.5) curve.points.emplace_back(point.time, point.length);
  }
  return curve;
}

}  // namespace

Outcome damBreak(gpu::Context& ctx, bool quick) {
  std::vector<Row> rows;
  Figure figure{.name = "dam-break",
                .title = "Front of a collapsing column, height twice its length a",
                .x_label = "time T = t sqrt(2 g / a) [-]",
                .y_label = "front Z = x / a [-]",
                .curves = {curveOf("Martin & Moyce, a = 2.25 in", kWide), curveOf("a = 1.125 in", kNarrow)}};
  for (Figure::Curve& curve : figure.curves) curve.is_measured = true;
  for (const core::PressureSolver solver : kSolvers) {
    for (const core::KernelSet set : kKernelSets) {
      // The quick table uses the default kernel set of each solver.
      if (quick && set != core::KernelSet::kWendlandC2) continue;
      auto computed = collapse(ctx, damScene(solver, set, 40));
      if (!computed) return computed.error();
      const std::string name = fmt::format("{}, {}, {} Pa s", nameOf(solver), nameOf(set), viscosity(solver, set));
      compare(computed->front, kWide, name, "a = 2.25 in", rows);
      compare(computed->front, kNarrow, name, "a = 1.125 in", rows);
      describe(*computed, name, rows);
      if (set != core::KernelSet::kWendlandC2) continue;
      figure.curves.push_back(curveOf(nameOf(solver), computed->front));
      figure.curves.push_back(curveOf(std::string(nameOf(solver)) + ", leading edge", computed->tongue));
    }
  }
  return CaseResult{std::move(rows), {std::move(figure)}};
}

}  // namespace spindrift::study
