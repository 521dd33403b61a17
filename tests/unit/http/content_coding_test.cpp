#include <gtest/gtest.h>

#include <spindrift/http/static_files.h>

namespace spindrift::net {
namespace {

TEST(CodingWeight, ReadsNamesWeightsAndTheRest) {
  EXPECT_EQ(codingWeight("", "gzip"), 0.0);
  EXPECT_EQ(codingWeight("gzip", "gzip"), 1.0);
  EXPECT_EQ(codingWeight("deflate, GZIP;q=0.25 ,br", "gzip"), 0.25);
  EXPECT_EQ(codingWeight("deflate ; Q=0.5", "deflate"), 0.5);
  EXPECT_EQ(codingWeight("xgzip, gzipx", "gzip"), 0.0);
  EXPECT_EQ(codingWeight("*;q=0.125, gzip;q=0", "gzip"), 0.0);
  EXPECT_EQ(codingWeight("*;q=0.125, gzip;q=0", "br"), 0.125);
}

TEST(CodingWeight, TakesNoMalformedEntry) {
  for (const char* list : {"gzip;", "gzip;q", "gzip;q=", "gzip;q=x", "gzip;q=0.5x", "gzip;q=2", "gzip;q=-1",
                           "gzip;q=nan", ",;,=,", " , "}) {
    EXPECT_EQ(codingWeight(list, "gzip"), 0.0) << list;
  }
}

}  // namespace
}  // namespace spindrift::net
