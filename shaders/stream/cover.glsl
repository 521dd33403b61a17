// Finds the cells of a row of n that a sample of a coarser row covers, and the covered share of each cell.
#ifndef SPINDRIFT_COVER
#define SPINDRIFT_COVER

/// A sample from `low` to `low + width`, in cells; it covers a part of the cells `first` to `last`.
struct Cover {
  float low;
  float width;
  int first;
  int last;
};

Cover coverOf(int sample_index, int n, int sample_count) {
  const float width = float(n) / float(sample_count);
  const float low = float(sample_index) * width;
  // Overlaps below the rounding error do not count.
  return Cover(low, width, int(floor(low + 1e-3)), min(int(ceil(low + width - 1e-3)), n) - 1);
}

/// 0..1: share of the cell that the sample covers.
float weightIn(Cover c, int cell) { return min(float(cell) + 1.0, c.low + c.width) - max(float(cell), c.low); }

#endif
