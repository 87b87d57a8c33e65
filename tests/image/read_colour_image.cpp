// Pictures in their colours, as the decoder gives them.
#include <gtest/gtest.h>

#include <cmath>

#include "compiler/image/decode_picture.hpp"
#include "compiler/image/decoder_answer.hpp"
#include "tests/image/encoding.hpp"

namespace wale::read_colour_image_test {
namespace {

ColourImage read(const Bytes& bytes, const std::string& name) {
  auto image = read_colour_image(bytes, name);
  EXPECT_TRUE(image) << (image ? "" : image.error().sentence);
  return image ? *image : ColourImage{};
}

TEST(ReadColourImage, GivesTheBytesThatTheFileStores) {
  // Three columns and two rows, each with bytes of its own.
  std::vector<std::uint8_t> codes;
  for (std::uint8_t i = 0; i < 18; ++i) codes.push_back(static_cast<std::uint8_t>(10 * i + 3));
  for (const char* extension : {"png", "tif", "bmp", "ppm", "tga"}) {
    const auto image =
        read(encode(extension, OIIO::ImageSpec(3, 2, 3, OIIO::TypeUInt8), codes), std::string("a.") + extension);
    ASSERT_EQ(image.width, 3u) << extension;
    ASSERT_EQ(image.height, 2u) << extension;
    for (std::size_t i = 0; i < 6; ++i)
      EXPECT_EQ(image.pixels[i], 0xff000000u | codes[3 * i] << 16 | codes[3 * i + 1] << 8 | codes[3 * i + 2])
          << extension;
  }
}

TEST(ReadColourImage, KeepsAlphaAndDoesNotMultiplyByIt) {
  const std::vector<std::uint8_t> codes = {200, 100, 50, 255, 200, 100, 50, 64, 1, 2, 3, 0};
  OIIO::ImageSpec spec(3, 1, 4, OIIO::TypeUInt8);
  spec.attribute("oiio:UnassociatedAlpha", 1);  // written as they are
  const auto image = read(encode("png", spec, codes), "a.png");
  EXPECT_EQ(image.pixels, (std::vector<std::uint32_t>{0xffc86432, 0x40c86432, 0x00010203}));
}

TEST(ReadColourImage, GreyHasThreeEqualParts) {
  const auto image =
      read(encode("png", OIIO::ImageSpec(2, 1, 1, OIIO::TypeUInt8), std::vector<std::uint8_t>{7, 250}), "a.png");
  EXPECT_EQ(image.pixels, (std::vector<std::uint32_t>{0xff070707, 0xfffafafa}));
}

TEST(ReadColourImage, IsTurnedAsTheCameraWasHeld) {
  // a b
  // c d
  // e f, by their red. What is shown is from the table of the Exif standard.
  const std::vector<std::uint8_t> codes = {1, 0, 0, 2, 0, 0, 3, 0, 0, 4, 0, 0, 5, 0, 0, 6, 0, 0};
  const std::vector<std::vector<std::uint32_t>> shown = {{1, 2, 3, 4, 5, 6}, {2, 1, 4, 3, 6, 5}, {6, 5, 4, 3, 2, 1},
                                                         {5, 6, 3, 4, 1, 2}, {1, 3, 5, 2, 4, 6}, {5, 3, 1, 6, 4, 2},
                                                         {6, 4, 2, 5, 3, 1}, {2, 4, 6, 1, 3, 5}};
  for (int orientation = 1; orientation <= 8; ++orientation) {
    OIIO::ImageSpec spec(2, 3, 3, OIIO::TypeUInt8);
    spec.attribute("Orientation", orientation);
    const auto image = read(encode("tif", spec, codes), "a.tif");
    ASSERT_EQ(image.width, orientation < 5 ? 2u : 3u) << orientation;
    std::vector<std::uint32_t> red;
    for (const std::uint32_t each : image.pixels) red.push_back(each >> 16 & 255);
    EXPECT_EQ(red, shown[static_cast<std::size_t>(orientation - 1)]) << orientation;
  }
}

TEST(ReadColourImage, ALongPictureIsReducedToColoursThatItHas) {
  // 8192 columns of 4 pixels, alternately red and blue, four columns wide.
  std::vector<std::uint8_t> codes;
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 8192; ++x)
      for (const int part : {x / 4 % 2 == 0 ? 255 : 0, 0, x / 4 % 2 == 0 ? 0 : 255})
        codes.push_back(static_cast<std::uint8_t>(part));
  const auto image = read(encode("png", OIIO::ImageSpec(8192, 4, 3, OIIO::TypeUInt8), codes), "a.png");
  EXPECT_EQ(image.width, 4096u);
  EXPECT_EQ(image.height, 2u);
  EXPECT_NEAR(image.pixels_per_column, 2, 1e-9);
  for (const std::uint32_t each : image.pixels) EXPECT_TRUE(each == 0xffff0000 || each == 0xff0000ff) << each;
}

TEST(ReadColourImage, DamagedPicturesAreErrorsOrPictures) {
  Mutations mutations(1);
  for (const auto& [name, bytes] : one_of_each())
    for (int round = 0; round < 12; ++round) {
      const auto image = read_colour_image(mutations.of(bytes, round % 2 != 0), name);
      if (image) {
        EXPECT_EQ(image->pixels.size(), std::size_t{image->width} * image->height) << name;
      } else {
        EXPECT_FALSE(image.error().sentence.empty()) << name;
        EXPECT_EQ(image.error().place.name, name);
      }
    }
  EXPECT_EQ(read_colour_image({}, "a.png").error().code, Code::unreadable_image);
}

TEST(ColourAnswer, IsReadAsWrittenAndNothingElseIs) {
  const ColourImage image{3, 2, {1, 2, 3, 4, 5, 0xffffffff}, 1.5, 1};
  const Bytes whole = write_colour_answer(image);
  const auto back = read_colour_answer(whole);
  ASSERT_TRUE(back && *back);
  EXPECT_EQ((*back)->pixels, image.pixels);
  EXPECT_EQ((*back)->pixels_per_column, 1.5);
  for (std::size_t size = 0; size < whole.size(); ++size)
    EXPECT_FALSE(read_colour_answer(std::span(whole).first(size))) << size;
  EXPECT_FALSE(read_answer(whole)) << "colours are no heights";
  EXPECT_FALSE(read_colour_answer(write_answer(HeightImage{{5, 4, std::vector<std::uint16_t>(20, 1)}, 1, 1})));
  const auto error = read_colour_answer(write_colour_answer(Error{Code::image_size, "too large", "make it smaller"}));
  ASSERT_TRUE(error && !*error);
  EXPECT_EQ(error->error().code, Code::image_size);
}

}  // namespace
}  // namespace wale::read_colour_image_test
