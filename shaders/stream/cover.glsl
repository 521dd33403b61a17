// Which cells of a row of n are covered by a sample of a row with fewer samples, and with which share.
#ifndef SPINDRIFT_COVER
#define SPINDRIFT_COVER

/// From `low`, `width` cells wide; cells `first` to `last` have a share in it.
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

/// 0..1: the part of the cell that lies in the sample.
float weightIn(Cover c, int cell) { return min(float(cell) + 1.0, c.low + c.width) - max(float(cell), c.low); }

#endif
