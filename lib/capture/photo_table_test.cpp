#include "capture/photo_table.h"

#include <gtest/gtest.h>

#include "base/scratch_for_test.h"

namespace goniochrome::capture::photo_table_test {
namespace {

const std::string kHead = "image,light_x,light_y,light_z,camera_x,camera_y,camera_z,exposure\n";

std::string told(const std::string& text) {
  const ScratchFolder folder;
  const auto table = read_photo_table(folder.file("photos.csv", text));
  return table.ok() ? "nothing" : table.error().message;
}

TEST(PhotoTable, ReadsPlacesAndDirections) {
  const ScratchFolder folder;
  const auto table = read_photo_table(folder.file(
      "photos.csv",
      "\xef\xbb\xbf# a rig\r\nexposure,image,light_x,light_y,light_z,light_distance,camera_x,camera_y,camera_z\r\n"
      "2,a.png,0,3,4,10,1,0,2\r\n\r\n0.5,/b.png,0,3,4,inf,1,0,2\r\n1,c.png,0,3,4,,1,0,2\r\n"));
  ASSERT_TRUE(table.ok()) << table.error().message;
  ASSERT_EQ(table->photos.size(), 3u);
  EXPECT_EQ(table->photos[0].image, folder.path("a.png"));
  EXPECT_EQ(table->photos[1].image, "/b.png");
  EXPECT_EQ(table->photos[0].line, 3);
  EXPECT_EQ(table->photos[0].exposure, 2);
  EXPECT_NEAR(table->photos[0].light.where.z, 8, 1e-12);
  EXPECT_NEAR(table->photos[0].light.distance({0, 0, 0}), 10, 1e-12);
  EXPECT_TRUE(table->photos[1].light.parallel);
  EXPECT_NEAR(table->photos[1].light.direction({5, 5, 0}).y, 0.6, 1e-12);
  EXPECT_EQ(table->photos[1].light.distance({5, 5, 0}), 1);
  EXPECT_EQ(table->photos[2].light.where.z, 4);
}

TEST(PhotoTable, IsReadAsSpreadsheetsSaveIt) {
  const ScratchFolder folder;
  const auto table =
      read_photo_table(folder.file("photos.csv",
                                   "# a rig, two\nimage;light_x;light_y;light_z;camera_x;camera_y;camera_z;"
                                   "exposure\n\"a;1.png\";0;0;1,5;0;0;1;2\n;;;;;;;\n"));
  ASSERT_TRUE(table.ok()) << table.error().message;
  ASSERT_EQ(table->photos.size(), 1u);
  EXPECT_EQ(table->photos[0].image, folder.path("a;1.png"));
  EXPECT_EQ(table->photos[0].light.where.z, 1.5);
}

TEST(PhotoTable, NamesTheLineAndTheRemedy) {
  EXPECT_NE(told("").find("is empty"), std::string::npos);
  EXPECT_NE(told(kHead).find("names no photograph"), std::string::npos);
  EXPECT_NE(told("image,light_x\n").find(":1: the column light_y is missing"), std::string::npos);
  EXPECT_NE(told("image,lightx\n").find("\"lightx\" is not known"), std::string::npos);
  EXPECT_NE(told("image,image\n").find("image is there twice"), std::string::npos);
  EXPECT_NE(told(kHead + "a.png,0,0,1,0,0,1\n").find(":2: 7 cells, but the first row names 8"), std::string::npos);
  EXPECT_NE(told(kHead + "a.png,0,0,x,0,0,1,1\n").find(":2: light_z is \"x\": write a number"), std::string::npos);
  EXPECT_NE(told(kHead + "a.png,0,0,1,0,0,1,0\n").find("exposure is 0: give the linear value"), std::string::npos);
  EXPECT_NE(told(kHead + ",0,0,1,0,0,1,1\n").find("image is empty"), std::string::npos);
  const std::string far = "light_distance," + kHead;
  EXPECT_NE(told(far + "-1,a.png,0,0,1,0,0,1,1\n").find("light_distance is -1: give a length above 0"),
            std::string::npos);
  EXPECT_NE(told(far + "1,a.png,0,0,0,0,0,1,1\n").find("which is no direction"), std::string::npos);
}

TEST(PhotoTable, CornersAreOfARowThatHasThem) {
  const ScratchFolder folder;
  const std::string head =
      "corner1_x,corner1_y,corner2_x,corner2_y,corner3_x,corner3_y,corner4_x,corner4_y,k1," + kHead;
  const auto table = read_photo_table(
      folder.file("photos.csv", head + "1,2,9,3,8,7,0.5,6,-0.1,a.png,0,0,1,0,0,1,1\n,,,,,,,,,b.png,0,0,1,0,0,1,1\n"));
  ASSERT_TRUE(table.ok()) << table.error().message;
  ASSERT_TRUE(table->photos[0].corners.has_value());
  EXPECT_EQ(table->photos[0].corners->at[3].x, 0.5);
  EXPECT_EQ(table->photos[0].corners->at[1].y, 3);
  EXPECT_EQ(table->photos[0].corners->k1, -0.1);
  EXPECT_FALSE(table->photos[1].corners.has_value());
  EXPECT_NE(told(head + "1,2,9,3,8,7,0.5,,0,a.png,0,0,1,0,0,1,1\n").find(":2: corner4_y is \"\": write a number"),
            std::string::npos);
  EXPECT_NE(told(head + "1,2,9,3,8,7,0.5,6,0.5,a.png,0,0,1,0,0,1,1\n").find(":2: k1 is 0.5: give a number from -.3"),
            std::string::npos);
  EXPECT_NE(told("corner1_x," + kHead).find("there are some columns of corners"), std::string::npos);
  EXPECT_NE(told("k1," + kHead).find("k1 is for photographs with corners"), std::string::npos);
}

TEST(PhotoTable, StationsThatTellNothingAreRefused) {
  const auto check = [](const std::string& rows, int least) {
    const ScratchFolder folder;
    const auto table = read_photo_table(folder.file("photos.csv", kHead + rows));
    if (!table.ok()) return table.error().message;
    const auto checked = check_stations(*table, 0.1, 0.1, least);
    return checked.ok() ? std::string("nothing") : checked.error().message;
  };
  const std::string around = "a,0,3,4,0,-3,4,1\nb,3,0,4,-3,0,4,1\nc,0,-3,4,0,1,4,1\nd,1,1,4,1,-1,4,1\n";
  EXPECT_EQ(check(around, 4), "nothing");
  EXPECT_NE(check(around, 5).find("4 photographs to fit are too few"), std::string::npos);
  EXPECT_NE(check(around + "e,0,0,-1,0,0,4,1\n", 4).find(":6: the light is below the surface (light_z is not above 0)"),
            std::string::npos);
  EXPECT_NE(check(around + "e,0,0,1,0,0,0,1\n", 4).find(":6: the camera is below the surface"), std::string::npos);
  EXPECT_NE(check("a,3,0,4,3,0,4,1\nb,3,1,4,3,1,4,1\nc,3,-1,4,3,-1,4,1\nd,2,0,4,3,0,4,1\n", 4)
                .find("one side of its highlight"),
            std::string::npos);
  EXPECT_NE(check("a,0,0,4,3,0,4,1\nb,0,0,4,-3,0,4,1\nc,0,0.1,4,0,3,4,1\nd,0,0,4,0,-3,4,1\n", 4)
                .find("all lights are within"),
            std::string::npos);
}

}  // namespace
}  // namespace goniochrome::capture::photo_table_test
