// SPDX-License-Identifier: Apache-2.0
#include <vector>

#include <gtest/gtest.h>

#include <polhode/system/history_record.hpp>

namespace polhode::history_record_tests {
namespace {

struct Inner {
  double first = 0.0, second = 0.0;
};
struct Record {
  double number, vector[3];
  Inner inner;
};

}  // namespace

static_assert(kNumbersOf<Record> == 6);
static_assert(!HistoryRecord<std::vector<double>>);
static_assert(!HistoryRecord<Vec3>, "its copy may do anything");

TEST(HistoryRecord, IsStoredFieldAfterField) {
  std::vector<double> history(8, -1.0);
  Record record{1.0, {2.0, 3.0, 4.0}, {5.0, 6.0}};
  write_record(record, history.data() + 1);
  EXPECT_EQ(history, (std::vector<double>{-1.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, -1.0}));
  history[3] = 30.0;
  const auto read = read_record<Record>(history.data() + 1);
  EXPECT_EQ(Vec3(read.vector), Vec3(2.0, 30.0, 4.0));
  EXPECT_EQ(read.inner.second, 6.0);
  set(record.vector, Vec3(7.0, 8.0, 9.0));
  EXPECT_EQ(record.vector[2], 9.0);
}

}  // namespace polhode::history_record_tests
