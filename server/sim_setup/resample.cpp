#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <spindrift/sim_setup/resample.h>

namespace spindrift::sim {
namespace {

/// Smaller shares of a cell are rounding.
constexpr double kNoShare = 1e-9;

/// Part of an old cell that a new cell covers, both in old cells: 0 to 1 within the cell.
struct Overlap {
  std::size_t cell;
  double begin, end;
};

std::vector<std::vector<Overlap>> overlapsOf(std::uint32_t from_count, std::uint32_t to_count, double shift_cells) {
  const double ratio = static_cast<double>(from_count) / to_count;
  const auto n = static_cast<std::int64_t>(from_count);
  std::vector<std::vector<Overlap>> out(to_count);
  for (std::uint32_t k = 0; k < to_count; ++k) {
    const double begin = (k + shift_cells) * ratio - shift_cells;
    const double end = (k + 1 + shift_cells) * ratio - shift_cells;
    for (auto cell = static_cast<std::int64_t>(std::floor(begin)); static_cast<double>(cell) < end; ++cell) {
      const double at = static_cast<double>(cell);
      const double from = std::clamp(begin - at, 0.0, 1.0);
      const double to = std::clamp(end - at, 0.0, 1.0);
      if (to - from > kNoShare) out[k].push_back({static_cast<std::size_t>((cell % n + n) % n), from, to});
    }
  }
  return out;
}

/// a(u) = left + u (rise + bulge (1 - u)), u from 0 to 1.
struct Parabola {
  double left = 0.0, rise = 0.0, bulge = 0.0;

  double integral(double u0, double u1) const {
    return left * (u1 - u0) + 0.5 * (rise + bulge) * (u1 * u1 - u0 * u0) - bulge / 3 * (u1 * u1 * u1 - u0 * u0 * u0);
  }
};

/// The parabola in cell i of a line of cells; neighbours are absent where they are dry or beyond a side.
Parabola parabolaIn(const double* mean, const double* share, std::int64_t count, bool is_periodic, std::int64_t i) {
  const auto wrapped = [&](std::int64_t k) { return static_cast<std::size_t>((k % count + count) % count); };
  const auto at = [&](std::int64_t k) { return mean[wrapped(k)]; };
  const auto has = [&](std::int64_t k) {
    if (!is_periodic && (k < 0 || k >= count)) return false;
    return share[wrapped(k)] > kNoShare;
  };
  /// Value at the edge between cells k and k + 1, both wet.
  const auto edge = [&](std::int64_t k) {
    if (!has(k) || !has(k + 1)) return 0.0;
    const double a = at(k), b = at(k + 1);
    if (!has(k - 1) || !has(k + 2)) return 0.5 * (a + b);
    const double wanted = (7 * (a + b) - at(k - 1) - at(k + 2)) / 12;
    return std::clamp(wanted, std::min(a, b), std::max(a, b));
  };
  const double v = mean[i];
  double left = edge(i - 1), right = edge(i);
  if (!has(i - 1)) left = v;
  if (!has(i + 1)) right = v;
  if ((right - v) * (v - left) <= 0) return {v, 0.0, 0.0};
  const double rise = right - left;
  const double bulge = 6 * (v - 0.5 * (left + right));
  if (rise * bulge > rise * rise) {
    left = 3 * v - 2 * right;
  } else if (-rise * rise > rise * bulge) {
    right = 3 * v - 2 * left;
  }
  return {left, right - left, 6 * (v - 0.5 * (left + right))};
}

/// Resamples along the fast axis and exchanges the axes, so that a second pass treats the other one.
Field pass(const Field& from, std::uint32_t from_count, std::uint32_t to_count, SampleAxis axis) {
  const std::size_t line_count = from.mean.size() / from_count;
  const auto overlaps = overlapsOf(from_count, to_count, axis.shift_cells);
  const double width = static_cast<double>(from_count) / to_count;
  Field out{std::vector<double>(line_count * to_count), std::vector<double>(line_count * to_count)};
  std::vector<Parabola> parabolas(from_count);
  const bool is_joined = axis.is_periodic || axis.shift_cells != 0.0;
  for (std::size_t z = 0; z < line_count; ++z) {
    const double* const mean = from.mean.data() + z * from_count;
    const double* const share = from.share.data() + z * from_count;
    for (std::uint32_t i = 0; i < from_count; ++i)
      parabolas[i] = share[i] > kNoShare ? parabolaIn(mean, share, from_count, is_joined, i) : Parabola{};
    for (std::uint32_t k = 0; k < to_count; ++k) {
      double held = 0.0, wet = 0.0;
      for (const Overlap& part : overlaps[k]) {
        held += share[part.cell] * parabolas[part.cell].integral(part.begin, part.end);
        wet += share[part.cell] * (part.end - part.begin);
      }
      const std::size_t at = z + line_count * k;
      if (wet <= kNoShare) continue;
      out.mean[at] = held / wet;
      out.share[at] = std::min(wet / width, 1.0);
    }
  }
  return out;
}

}  // namespace

Field resample(const Field& from, core::CellCounts from_count, core::CellCounts to, SampleAxis x, SampleAxis z) {
  return pass(pass(from, from_count.x, to.x, x), from_count.z, to.z, z);
}

void settleOn(std::span<const char> wet, core::CellCounts count, bool periodic_x, bool periodic_z, Field& field) {
  const auto nx = static_cast<int>(count.x);
  const auto nz = static_cast<int>(count.z);
  std::vector<std::size_t> empty;
  for (std::size_t i = 0; i < wet.size(); ++i) {
    const bool has_water = field.share[i] > kNoShare;
    field.share[i] = wet[i] && has_water ? 1.0 : 0.0;
    if (!wet[i] || !has_water) field.mean[i] = 0.0;
    if (wet[i] && !has_water) empty.push_back(i);
  }
  const auto neighbour = [&](std::size_t i, int dx, int dz) -> std::optional<std::size_t> {
    int x = static_cast<int>(i) % nx + dx;
    int z = static_cast<int>(i) / nx + dz;
    if (periodic_x) x = (x + nx) % nx;
    if (periodic_z) z = (z + nz) % nz;
    if (x < 0 || x >= nx || z < 0 || z >= nz) return std::nullopt;
    return static_cast<std::size_t>(x + nx * z);
  };
  while (!empty.empty()) {
    std::vector<std::pair<std::size_t, double>> found;
    std::vector<std::size_t> still;
    for (const std::size_t i : empty) {
      double sum = 0.0;
      int found_count = 0;
      for (const auto& [dx, dz] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}}) {
        const auto at = neighbour(i, dx, dz);
        if (!at || field.share[*at] == 0.0) continue;
        sum += field.mean[*at];
        ++found_count;
      }
      if (found_count > 0) {
        found.emplace_back(i, sum / found_count);
      } else {
        still.push_back(i);
      }
    }
    for (const auto& [i, value] : found) {
      field.mean[i] = value;
      field.share[i] = 1.0;
    }
    if (found.empty()) {
      for (const std::size_t i : still) field.share[i] = 1.0;
      return;
    }
    empty = std::move(still);
  }
}

std::vector<std::int64_t> wholeWithTotal(std::span<const double> values, std::span<const char> wet,
                                         std::int64_t total) {
  std::vector<std::int64_t> out(values.size(), 0);
  double sum = 0.0;
  std::int64_t wet_count = 0, last = -1;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!wet[i]) continue;
    sum += values[i];
    ++wet_count;
    last = static_cast<std::int64_t>(i);
  }
  if (wet_count == 0) return out;
  const double offset = (static_cast<double>(total) - sum) / static_cast<double>(wet_count);
  double rest = 0.0;
  std::int64_t given = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!wet[i]) continue;
    const double wanted = values[i] + offset + rest;
    out[i] = std::llround(wanted);
    rest = wanted - static_cast<double>(out[i]);
    given += out[i];
  }
  // The sum of the doubles above is exact to about a unit.
  out[static_cast<std::size_t>(last)] += total - given;
  return out;
}

}  // namespace spindrift::sim
