// SPDX-License-Identifier: Apache-2.0
#include <polhode/view/chunk.hpp>

#include <cmath>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

namespace polhode::chunk_tests {
namespace {

TEST(Chunk, RestoresEveryBitOfSinglePrecision) {
  std::vector<double> values;
  for (int i = 0; i < 300; ++i) values.push_back(std::sin(0.1 * i) * std::pow(10.0, i % 40 - 20));
  values[7] = std::numeric_limits<double>::infinity();
  values[8] = std::numeric_limits<double>::quiet_NaN();
  values[9] = -0.0;
  for (std::size_t width : {std::size_t{1}, std::size_t{3}, std::size_t{100}}) {
    const std::string bytes = unpack_words(pack_floats(values, width), values.size(), width);
    for (std::size_t i = 0; i < values.size(); ++i) {
      const auto expected = static_cast<float>(values[i]);
      EXPECT_EQ(std::memcmp(bytes.data() + 4 * i, &expected, 4), 0) << i << " of width " << width;
    }
  }
}

TEST(Chunk, MakesSlowMotionSmall) {
  std::vector<double> slow;
  for (int f = 0; f < 2000; ++f)
    for (int k = 0; k < 3; ++k) slow.push_back(1.0 + 1e-4 * f + k);
  EXPECT_LT(pack_floats(slow, 3).size(), slow.size());  // A quarter of four bytes each.
}

TEST(Chunk, RefusesBytesOfAnotherLength) {
  const std::vector<double> values{1.0, 2.0};
  EXPECT_THROW((void)unpack_words(pack_floats(values, 1), 3, 1), std::runtime_error);
  EXPECT_THROW((void)unpack_words("no such bytes", 2, 1), std::runtime_error);
}

TEST(Base64, IsThatOfTheStandard) {  // RFC 4648, section 10
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("fo"), "Zm8=");
  EXPECT_EQ(base64("foo"), "Zm9v");
  EXPECT_EQ(base64("foob"), "Zm9vYg==");
  EXPECT_EQ(base64("fooba"), "Zm9vYmE=");
  EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
}

}  // namespace
}  // namespace polhode::chunk_tests
