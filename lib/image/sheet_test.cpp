#include "image/sheet.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "image/label.h"

namespace goniochrome::image::sheet_test {
namespace {

ByteImage plain(int width, int height, std::uint8_t value) {
  return {width, height, std::vector<std::uint8_t>(3 * static_cast<std::size_t>(width * height), value)};
}

TEST(Sheet, PutsEachPictureIntoItsCell) {
  ContactSheet sheet(3, 2, 40, 30);
  ASSERT_EQ(sheet.cells(), 6);
  const ByteImage picture = plain(40, 30, 200);
  sheet.put(4, &picture, "a");
  const ByteImage& all = sheet.picture();
  // The middle of the lower row: a third and a half of the sheet.
  std::size_t count = 0;
  for (int y = 0; y < all.height; ++y)
    for (int x = 0; x < all.width; ++x) {
      if (all.pixel(x, y)[0] != 200) continue;
      ++count;
      EXPECT_TRUE(x > all.width / 3 && x < 2 * all.width / 3 && y > all.height / 2) << x << " " << y;
    }
  EXPECT_EQ(count, 40u * 30u);
}

// The letters below a picture are those of draw_label(), and a paint without a picture has its name.
TEST(Sheet, WritesTheNameBelow) {
  ContactSheet named(1, 1, 60, 20), empty(1, 1, 60, 20);
  named.put(0, nullptr, "red");
  Image text{60, 20, 3, std::vector<float>(3 * 60 * 20, 0.0F), {}};
  draw_label(text, 0, 0, "red", 1, {1, 1, 1});
  int dots = 0, letters = 0;
  for (std::size_t i = 0; i < text.data.size(); i += 3) dots += text.data[i] > 0;
  for (std::size_t i = 0; i < named.picture().rgb.size(); i += 3) letters += named.picture().rgb[i] > 220;
  EXPECT_EQ(letters, dots);
  EXPECT_EQ(named.picture().rgb.size(), empty.picture().rgb.size());
}

TEST(Sheet, CutsLabelsThatAreTooLong) {
  EXPECT_EQ(fitted_label("silver", 1, 36), "silver");
  EXPECT_EQ(fitted_label("silver_fine", 1, 36), "silv..");
  EXPECT_EQ(fitted_label("caf\xC3\xA9", 1, 100), "caf\x7F");
  EXPECT_EQ(fitted_label("x", 2, 5), "");
}

// "sheet:cell" of each name, with blanks between.
std::string places_of(int columns, int rows, const std::vector<std::string>& names) {
  SheetPlaces places(columns, rows);
  std::string all;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const SheetPlace place = places.next(names[i], i + 1 < names.size() ? names[i + 1] : "");
    all += (all.empty() ? "" : " ") + std::to_string(place.sheet) + ":" + std::to_string(place.cell);
  }
  return all;
}

TEST(Sheet, IsFilledByRowsAndThenTheNextOne) {
  EXPECT_EQ(places_of(2, 2, {"a", "b", "c", "d", "e"}), "0:0 0:1 0:2 0:3 1:0");
  EXPECT_EQ(places_of(2, 2, {"a", "a.b", "a.c"}), "0:0 0:1 0:2");
}

TEST(Sheet, HasAPaintInTheMiddleOfItsVariations) {
  EXPECT_EQ(places_of(3, 3, {"a", "a.1", "a.2", "a.3", "a.4", "a.5", "a.6", "a.7", "a.8"}),
            "0:4 0:0 0:1 0:2 0:3 0:5 0:6 0:7 0:8");
  // One of the first paint's variations is missing, and a paint without any follows.
  EXPECT_EQ(places_of(3, 3, {"a", "a.1", "a.2", "b", "b.1", "c", "d"}), "0:4 0:0 0:1 1:4 1:0 2:0 2:1");
  EXPECT_EQ(places_of(3, 3, {"x", "a", "a.1", "ab"}), "0:0 1:4 1:0 2:0");
}

}  // namespace
}  // namespace goniochrome::image::sheet_test
