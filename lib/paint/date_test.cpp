#include "paint/date.h"

#include <gtest/gtest.h>

namespace goniochrome::paint::date_test {

TEST(Date, IsWrittenInIso8601WhereItsOrderIsKnown) {
  EXPECT_EQ(plain_date("2021-11-26T07:54:25Z"), "2021-11-26T07:54:25Z");
  EXPECT_EQ(plain_date(" 2021-11-26 07:54 "), "2021-11-26T07:54");
  EXPECT_EQ(plain_date("2021/11/26 07:54:25.5"), "2021-11-26T07:54:25.5");
  EXPECT_EQ(plain_date("6.2.2021"), "2021-02-06");
  EXPECT_EQ(plain_date("26.11.2021 07:54:25"), "2021-11-26T07:54:25");
}

TEST(Date, StaysAsItStandsWhereItsOrderIsNotKnown) {
  for (const char* text : {"11/12/2021", "29/07/2003 02:09:31 PM", "31.2.2021", "2021-13-01", "26.11.21", "7164914",
                           "2021-11-26 noon", "", "20211126"})
    EXPECT_EQ(plain_date(text), text);
}

TEST(Date, HasATimeOfUtc) {
  EXPECT_EQ(seconds_of_date("1970-01-02"), 86400);
  EXPECT_EQ(seconds_of_date("2002-08-11T20:36:02Z"), 1029098162);
  EXPECT_EQ(seconds_of_date("2002-08-11T22:36:02+02:00"), 1029098162);
  EXPECT_EQ(seconds_of_date("2002-08-11T15:06:02-0530"), 1029098162);
  EXPECT_EQ(seconds_of_date("1970-01-02..1971-01-01"), 86400);
  EXPECT_FALSE(seconds_of_date("11/12/2021"));
  EXPECT_FALSE(seconds_of_date("2021-11-26T25:00"));
  EXPECT_EQ(date_of_seconds(1029098162), "2002-08-11T20:36:02Z");
  EXPECT_EQ(date_of_seconds(-1), "1969-12-31T23:59:59Z");
  EXPECT_EQ(date_of_seconds(1e300), "");
  EXPECT_EQ(day_of_date("2021-11-26T23:59+02:00..2021-11-28"), "2021-11-26");
}

TEST(Date, OfSeveralIsTheSpanOfAll) {
  EXPECT_EQ(span_of_dates("", "2021-11-26"), "2021-11-26");
  EXPECT_EQ(span_of_dates("2021-11-28", "2021-11-26"), "2021-11-26..2021-11-28");
  EXPECT_EQ(span_of_dates("2021-11-26..2021-11-28", "2021-11-27"), "2021-11-26..2021-11-28");
  EXPECT_EQ(span_of_dates("2021-11-26..2021-11-28", "2021-11-20..2021-11-30"), "2021-11-20..2021-11-30");
  EXPECT_EQ(span_of_dates("12/11/2021", "1/12/2021"), "12/11/2021..1/12/2021");
}

}  // namespace goniochrome::paint::date_test
