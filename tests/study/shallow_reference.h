// Shallow water along x in double precision by a scheme of another family: what cases without a closed form compare
// with.
#pragma once

#include <functional>
#include <span>
#include <vector>

namespace spindrift::study {

/// Value at a position that is `cells` cells from the first edge, linear between the middles of the cells; beyond the
/// first and the last middle theirs. Precondition: at least 2 values.
double betweenCells(std::span<const double> values, double cells);

/// The central-upwind scheme of Kurganov & Petrova (2007): second order, positive depth; level water stays level if its
/// shore is at the edge of a cell. Without friction, between walls. Positions count from 0 at the first wall.
class ShallowReference {
 public:
  struct Water {
    double level_m;       ///< of the surface; below the ground means dry
    double velocity_mps;  ///< toward +x
  };
  /// `ground_m`: height of the ground. Preconditions: length_m > 0, at least 4 cells.
  ShallowReference(double length_m, std::size_t cell_count, const std::function<double(double x_m)>& ground_m,
                   const std::function<Water(double x_m)>& start);

  /// Steps of at most 0.45 of the stable one until `duration_s` later.
  void advance(double duration_s);

  [[nodiscard]] double time_s() const { return time_s_; }
  /// Level of the surface, linear between the middles of the cells. [m]
  [[nodiscard]] double levelAt(double x_m) const;
  /// Water beyond a position. [m^2]
  [[nodiscard]] double waterBeyond(double x_m) const;

 private:
  /// Finds the rates of change of level and flow; returns the fastest wave. [m/s]
  double findRates(const std::vector<double>& level_m, const std::vector<double>& flow_m2ps);

  double cell_m_;
  double time_s_ = 0.0;
  std::vector<double> edge_m_;    ///< ground at the edges of the cells
  std::vector<double> ground_m_;  ///< mean of both edges
  std::vector<double> level_m_, flow_m2ps_;
  std::vector<double> level_rate_mps_, flow_rate_m2ps2_;
  std::vector<double> next_level_m_, next_flow_m2ps_;
};

}  // namespace spindrift::study
