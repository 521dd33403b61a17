// Place `i` of rows of `n` values: column and row. Exact up to 2^23 places. Processors divide eight floats at a time but integers one by
// one; the quotient is at most one off.
ivec2 placeOf(int i, int n) {
  int row = int((float(i) + 0.5) / float(n));
  row += int(i >= (row + 1) * n) - int(i < row * n);
  return ivec2(i - row * n, row);
}
