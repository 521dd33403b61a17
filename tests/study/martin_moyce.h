// Columns of water, twice as high as they are long, that collapse onto a dry floor (Martin & Moyce 1952, n^2 = 2).
#pragma once

#include <array>
#include <span>

namespace spindrift::study {

/// A published point: time and length, both without units.
struct ColumnPoint {
  double time;
  double length;
};

/// Leading edge Z = x/a against T = t sqrt(2 g/a), and the length a of the column.
struct EdgeSeries {
  const char* name;
  double length_m;
  std::span<const ColumnPoint> edge;
};

inline constexpr std::array<ColumnPoint, 15> kWideEdge = {{{0.832, 1.217},
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
inline constexpr std::array<ColumnPoint, 10> kNarrowEdge = {{{0.849, 1.245},
                                                             {1.212, 1.443},
                                                             {1.602, 1.884},
                                                             {2.283, 2.689},
                                                             {2.950, 3.728},
                                                             {3.598, 4.528},
                                                             {3.905, 4.999},
                                                             {4.592, 5.841},
                                                             {4.961, 6.271},
                                                             {5.316, 6.717}}};
inline constexpr std::array<EdgeSeries, 2> kEdgeSeries = {
    {{"a = 2.25 in", 0.05715, kWideEdge}, {"a = 1.125 in", 0.028575, kNarrowEdge}}};

/// Height of what is left at the wall, H = y/(2 a), against tau = t sqrt(g/a); a = 2.25 in (their table 6).
inline constexpr std::array<ColumnPoint, 16> kColumnHeights = {{{0.56, 0.94},
                                                                {0.77, 0.89},
                                                                {0.93, 0.83},
                                                                {1.08, 0.78},
                                                                {1.28, 0.72},
                                                                {1.46, 0.67},
                                                                {1.66, 0.61},
                                                                {1.84, 0.56},
                                                                {2.00, 0.50},
                                                                {2.21, 0.44},
                                                                {2.45, 0.39},
                                                                {2.70, 0.33},
                                                                {3.06, 0.28},
                                                                {3.44, 0.22},
                                                                {4.20, 0.17},
                                                                {5.25, 0.11}}};

}  // namespace spindrift::study
