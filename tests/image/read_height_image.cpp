#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <numbers>
#include <span>

#include "compiler/image/image.hpp"
#include "tests/image/encoding.hpp"

namespace wale::read_height_image_test {
namespace {

HeightImage read(const Bytes& bytes, const std::string& name, double smooth = 0) {
  auto image = read_height_image(bytes, name, smooth);
  if (!image) {
    ADD_FAILURE() << image.error().sentence;
    return {};
  }
  return *image;
}

std::string problem_of(const Bytes& bytes, const std::string& name, double smooth = 0) {
  auto image = read_height_image(bytes, name, smooth);
  if (!image) return image.error().sentence;
  ADD_FAILURE() << name << " was read";
  return {};
}

constexpr int width = 16, height = 8;
constexpr std::size_t pixels = width * height;

TEST(Image, SixteenBitPngIsTakenCodeForCode) {
  const auto codes = ramp<std::uint16_t>(pixels);
  const auto image = read(encode("png", OIIO::ImageSpec(width, height, 1, OIIO::TypeUInt16), codes), "slate.png");
  EXPECT_EQ(image.table.width, 16u);
  EXPECT_EQ(image.table.height, 8u);
  EXPECT_EQ(image.table.heights, codes);
  EXPECT_EQ(image.pixels_per_column, 1.0);
  EXPECT_EQ(image.pixels_per_row, 1.0);
}

TEST(Image, EightBitsSpanTheSameHeight) {
  const auto codes = ramp<std::uint8_t>(pixels);
  const auto image = read(encode("png", OIIO::ImageSpec(width, height, 1, OIIO::TypeUInt8), codes), "slate.png");
  ASSERT_EQ(image.table.heights.size(), pixels);
  for (std::size_t i = 0; i < pixels; ++i) EXPECT_EQ(image.table.heights[i], codes[i] * 257);  // 65535 / 255
}

TEST(Image, TiffFloatIsClampedAndNotANumberIsLow) {
  std::vector<float> values(pixels, 0.5f);
  values[0] = -3.0f;
  values[1] = 7.0f;
  values[2] = std::numeric_limits<float>::quiet_NaN();
  values[3] = std::numeric_limits<float>::infinity();
  values[4] = 0.25f;
  const auto image = read(encode("tif", OIIO::ImageSpec(width, height, 1, OIIO::TypeFloat), values), "slate.tif");
  ASSERT_EQ(image.table.heights.size(), pixels);
  EXPECT_EQ(image.table.heights[0], 0);
  EXPECT_EQ(image.table.heights[1], 65535);
  EXPECT_EQ(image.table.heights[2], 0);
  EXPECT_EQ(image.table.heights[3], 65535);
  EXPECT_EQ(image.table.heights[4], 16384);  // 0.25 * 65535 = 16383.75
  EXPECT_EQ(image.table.heights[5], 32768);  // half rounds up
}

TEST(Image, TiledAndScanlineTiffAgree) {
  const auto codes = ramp<std::uint16_t>(70 * 50);
  OIIO::ImageSpec spec(70, 50, 1, OIIO::TypeUInt16);
  const auto in_rows = read(encode("tif", spec, codes), "a.tif");
  spec.tile_width = spec.tile_height = 16;
  const auto in_tiles = read(encode("tif", spec, codes), "a.tif");
  EXPECT_EQ(in_rows.table, in_tiles.table);
  EXPECT_EQ(in_rows.table.heights, codes);
}

TEST(Image, ColoursAreWeighedByRec709WithoutLinearisation) {
  std::vector<std::uint8_t> codes(pixels * 3, 0);
  codes[0] = 255;      // red
  codes[3 + 1] = 255;  // green
  codes[6 + 2] = 255;  // blue
  codes[9] = codes[10] = codes[11] = 128;
  const auto image = read(encode("png", OIIO::ImageSpec(width, height, 3, OIIO::TypeUInt8), codes), "slate.png");
  ASSERT_EQ(image.table.heights.size(), pixels);
  EXPECT_EQ(image.table.heights[0], 13933);  // 0.2126 * 65535 = 13932.7
  EXPECT_EQ(image.table.heights[1], 46871);  // 0.7152 * 65535 = 46870.6
  EXPECT_EQ(image.table.heights[2], 4732);   // 0.0722 * 65535 = 4731.6
  EXPECT_EQ(image.table.heights[3], 128 * 257);
}

TEST(Image, AlphaNeitherHidesNorScales) {
  std::vector<std::uint16_t> grey_alpha, rgb, rgba;
  const auto codes = ramp<std::uint16_t>(pixels * 3);
  for (std::size_t i = 0; i < pixels; ++i) {
    const auto alpha = static_cast<std::uint16_t>(i % 3 * 20000);
    grey_alpha.insert(grey_alpha.end(), {codes[i], alpha});
    rgb.insert(rgb.end(), {codes[3 * i], codes[3 * i + 1], codes[3 * i + 2]});
    rgba.insert(rgba.end(), {codes[3 * i], codes[3 * i + 1], codes[3 * i + 2], alpha});
  }
  for (const char* extension : {"png", "tif"}) {
    const auto spec_of = [](int channels) {
      OIIO::ImageSpec spec(width, height, channels, OIIO::TypeUInt16);
      spec.attribute("oiio:UnassociatedAlpha", 1);
      if (channels == 2) spec.alpha_channel = 1, spec.channelnames = {"Y", "A"};
      return spec;
    };
    const std::string name = std::string("slate.") + extension;
    const auto grey = read(encode(extension, spec_of(2), grey_alpha), name);
    EXPECT_EQ(grey.table.heights, std::vector(codes.begin(), codes.begin() + pixels)) << extension;
    const auto opaque = read(encode(extension, spec_of(3), rgb), name);
    EXPECT_EQ(read(encode(extension, spec_of(4), rgba), name).table, opaque.table) << extension;
  }
}

TEST(Image, ExrIsReadInHalfAndFloat) {
  const std::vector<float> values(pixels * 3, 0.5f);
  for (auto type : {OIIO::TypeHalf, OIIO::TypeFloat}) {
    const auto image = read(encode("exr", OIIO::ImageSpec(width, height, 3, type), values), "slate.exr");
    ASSERT_EQ(image.table.heights.size(), pixels);
    for (auto code : image.table.heights) EXPECT_NEAR(code, 32768, 1);
  }
}

TEST(Image, JpegIsReadNearItsCodes) {
  std::vector<std::uint8_t> codes(64 * 64);
  for (std::size_t i = 0; i < codes.size(); ++i) codes[i] = static_cast<std::uint8_t>(i % 64 * 4);
  OIIO::ImageSpec spec(64, 64, 1, OIIO::TypeUInt8);
  spec.attribute("Compression", "jpeg:100");
  const auto image = read(encode("jpg", spec, codes), "slate.jpg");
  ASSERT_EQ(image.table.heights.size(), codes.size());
  for (std::size_t i = 0; i < codes.size(); ++i) EXPECT_NEAR(image.table.heights[i], codes[i] * 257, 3 * 257);
}

TEST(Image, CameraOrientationIsApplied) {
  const auto codes = ramp<std::uint16_t>(pixels);
  OIIO::ImageSpec spec(width, height, 1, OIIO::TypeUInt16);
  spec.attribute("Orientation", 6);  // the stored top row is the right-hand side
  const auto image = read(encode("tif", spec, codes), "slate.tif");
  ASSERT_EQ(image.table.width, 8u);
  ASSERT_EQ(image.table.height, 16u);
  EXPECT_EQ(image.table.heights[7], codes[0]);
  EXPECT_EQ(image.table.heights[0], codes[pixels - width]);
}

TEST(Image, FormatIsKnownByItsBytesWhateverTheName) {
  const auto codes = ramp<std::uint16_t>(pixels);
  const Bytes png = encode("png", OIIO::ImageSpec(width, height, 1, OIIO::TypeUInt16), codes);
  for (const char* name : {"slate.tif", "slate.jpg", "slate", "slate.wale", ".png", "", "slate.null"}) {
    EXPECT_EQ(read(png, name).table.heights, codes) << name;
  }
}

TEST(Image, FormatThatNeedsAFileFindsItInMemory) {
  // SGI, version 1, one byte a sample, one channel, uncompressed: a header of 512 bytes, then rows from the bottom.
  Bytes sgi(512 + pixels, std::byte{0});
  const unsigned char header[] = {0x01, 0xda, 0, 1, 0, 2, 0, width, 0, height, 0, 1, 0, 0, 0, 0, 0, 0, 0, 255};
  std::memcpy(sgi.data(), header, sizeof header);
  for (std::size_t i = 0; i < pixels; ++i) sgi[512 + i] = static_cast<std::byte>(i);
  const auto image = read(sgi, "slate.sgi");
  ASSERT_EQ(image.table.heights.size(), pixels);
  EXPECT_EQ(image.table.heights[0], 112 * 257);  // the last row of the file is the top
  EXPECT_NE(problem_of(Bytes(600, std::byte{7}), "slate.sgi"), "");

  // FITS: cards of 80 characters in blocks of 2880 bytes, then rows from the bottom.
  std::string fits;
  for (std::string card :
       {"SIMPLE  =                    T", "BITPIX  =                    8", "NAXIS   =                    2",
        "NAXIS1  =                   16", "NAXIS2  =                    8", "END"}) {
    card.resize(80, ' ');
    fits += card;
  }
  fits.resize(2880, ' ');
  for (std::size_t i = 0; i < 2880; ++i) fits += static_cast<char>(i < pixels ? i : 0);
  const auto bytes = std::as_bytes(std::span(fits));
  const auto of_fits = read({bytes.begin(), bytes.end()}, "slate.fits");
  ASSERT_EQ(of_fits.table.heights.size(), pixels);
  // OpenImageIO 2.4 begins a row too late, so the first one is missing.
  for (std::size_t i = width; i < pixels; ++i) EXPECT_EQ(of_fits.table.heights[i], image.table.heights[i - width]) << i;
}

TEST(Image, SmoothingIsAGaussianOfTheStatedWidth) {
  constexpr int side = 65, middle = 32;
  constexpr double sigma = 2.5;
  std::vector<std::uint16_t> codes(side * side, 0);
  codes[middle * side + middle] = 65535;
  const auto image = read(encode("png", OIIO::ImageSpec(side, side, 1, OIIO::TypeUInt16), codes), "a.png", sigma);
  ASSERT_EQ(image.table.heights.size(), codes.size());
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      const double r2 = (x - middle) * (x - middle) + (y - middle) * (y - middle);
      const double expected = 65535 * std::exp(-r2 / (2 * sigma * sigma)) / (2 * std::numbers::pi * sigma * sigma);
      EXPECT_NEAR(image.table.heights[static_cast<std::size_t>(y * side + x)], expected, 1.0) << x << ", " << y;
    }
  }
}

TEST(Image, SmoothingContinuesTheEdge) {
  const std::vector<std::uint16_t> codes(pixels, 40000);
  const auto image = read(encode("png", OIIO::ImageSpec(width, height, 1, OIIO::TypeUInt16), codes), "a.png", 5);
  for (auto code : image.table.heights) EXPECT_NEAR(code, 40000, 1);
}

TEST(Image, TooMuchSmoothingIsRefused) {
  const Bytes png = encode("png", OIIO::ImageSpec(width, height, 1, OIIO::TypeUInt16), ramp<std::uint16_t>(pixels));
  EXPECT_NE(problem_of(png, "a.png", 65).find("64 is the most"), std::string::npos);
  problem_of(png, "a.png", -1);
  problem_of(png, "a.png", std::nan(""));
}

TEST(Image, LargePictureIsResizedAndSaysByHowMuch) {
  constexpr int long_side = 8192;
  std::vector<std::uint8_t> codes(static_cast<std::size_t>(long_side) * 20);
  for (std::size_t i = 0; i < codes.size(); ++i) codes[i] = i % long_side < long_side / 2 ? 0 : 255;
  const auto image = read(encode("png", OIIO::ImageSpec(long_side, 20, 1, OIIO::TypeUInt8), codes), "a.png");
  EXPECT_EQ(image.table.width, 4096u);
  EXPECT_EQ(image.table.height, 10u);
  EXPECT_EQ(image.pixels_per_column, 2.0);
  EXPECT_EQ(image.pixels_per_row, 2.0);
  EXPECT_EQ(image.table.heights[2000], 0);
  EXPECT_EQ(image.table.heights[2100], 65535);
  for (std::size_t i = 1; i < 4096; ++i) EXPECT_GE(image.table.heights[i], image.table.heights[i - 1]);  // no ringing
}

TEST(Image, SmallPicturesAreRefused) {
  for (auto [w, h] : {std::pair{1, 1}, {3, 100}, {100, 3}}) {
    const std::vector<std::uint8_t> codes(static_cast<std::size_t>(w * h), 9);
    const std::string problem = problem_of(encode("png", OIIO::ImageSpec(w, h, 1, OIIO::TypeUInt8), codes), "a.png");
    EXPECT_EQ(problem, "the picture has " + std::to_string(w) + " x " + std::to_string(h) +
                           " pixels, and heights need at least 4 x 4");
  }
}

TEST(Image, DeclaredHugePictureIsRefusedBeforeItIsRead) {
  // A BMP header that promises 30000 x 30000 pixels, with none behind it.
  Bytes bmp(54, std::byte{0});
  const auto put = [&](std::size_t at, std::uint32_t value) { std::memcpy(&bmp[at], &value, 4); };
  bmp[0] = std::byte{'B'}, bmp[1] = std::byte{'M'};
  put(2, 54), put(10, 54), put(14, 40), put(18, 30000), put(22, 30000), put(26, 1 | 24 << 16);
  EXPECT_EQ(problem_of(bmp, "a.bmp"),
            "the picture has 30000 x 30000 pixels, more than the 16777216 that a patch can use");
  const Error error = read_height_image(bmp, "a.bmp", 0).error();
  EXPECT_EQ(error.code, Code::image_size);
  EXPECT_EQ(error.mend, "resize it to at least 4 x 4 pixels and at most 4096 x 4096");
}

TEST(Image, OtherFilesAreRefused) {
  EXPECT_EQ(problem_of({}, "a.png"), "the file is empty");
  const Bytes words(300, std::byte{'w'});
  EXPECT_EQ(problem_of(words, "a.txt"), "the file is in no picture format that OpenImageIO knows");
  EXPECT_NE(problem_of(words, "a.png"), "");
  EXPECT_NE(problem_of(words, "a.null"), "");  // OpenImageIO's "null" makes a picture of nothing
  EXPECT_EQ(problem_of(words, "a.dpx"), "pictures in the format dpx are not read");
  EXPECT_EQ(read_height_image(words, "a.dpx", 0).error().mend, "save it as PNG, TIFF, JPEG or EXR");
  EXPECT_EQ(read_height_image(words, "a.dpx", 0).error().place.name, "a.dpx");
}

TEST(Image, TruncatedFilesAreRefusedWithASentence) {
  for (const auto& [name, bytes] : one_of_each()) {
    read(bytes, name);
    for (double part : {0.02, 0.3, 0.6}) {
      const Bytes cut(bytes.begin(),
                      bytes.begin() + static_cast<std::ptrdiff_t>(part * static_cast<double>(bytes.size())));
      EXPECT_NE(problem_of(cut, name), "") << name << " at " << part;
    }
  }
}

TEST(Image, DamagedFilesNeverCrashAndPrintNothing) {
  testing::internal::CaptureStderr();
  testing::internal::CaptureStdout();
  Mutations mutations(1);
  for (const auto& [name, bytes] : one_of_each())
    for (int round = 0; round < 6; ++round) {
      const auto image = read_height_image(mutations.of(bytes, round % 2 != 0), name, 0);
      if (image) continue;
      EXPECT_TRUE(image.error().code == Code::unreadable_image || image.error().code == Code::image_size) << name;
      EXPECT_NE(image.error().sentence, "") << name;
    }
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST(Image, SameBytesSameHeights) {
  const auto codes = ramp<std::uint16_t>(300 * 200);
  const Bytes png = encode("png", OIIO::ImageSpec(300, 200, 1, OIIO::TypeUInt16), codes);
  EXPECT_EQ(read(png, "a.png", 3).table, read(png, "a.png", 3).table);
}

}  // namespace
}  // namespace wale::read_height_image_test
