#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "wale/program.hpp"
#include "wale/result.hpp"

/// The files of the Sandpaper system of 1995 (Minsky, Appendix B, "File Formats Reference"), read and written, and what
/// they are in Wale. Functions of values: none of them opens a file. All are safe from any thread.
///
/// Its binary workspaces (type TXPS) are not read: the thesis prints the order of their fields, and not their sizes.
namespace wale {

/// An array or a wave: "Array files are arrays of unsigned 8-bit values. The first four bytes of an array file are the
/// width and height, as one-based big-endian two-byte integers. The remaining bytes are the elements of the array,
/// stored in row-major order." "Wave files have the same format as array files, but are used differently".
struct ThesisArray {
  std::uint16_t width = 0, height = 0;  ///< cells, 1 or more
  /// Row by row, width * height. Of a surface map (".depth") heights, "where 0 is lowest"; of a visual representation
  /// (".shade") "luminance, where 0 is white and 255 is black". The file does not say which of them it is.
  std::vector<std::uint8_t> cells;

  friend bool operator==(const ThesisArray&, const ThesisArray&) = default;
};

/// Reads an array or a wave. `name` is for errors. Errors: `damaged_file` for a file that is shorter than its header, for
/// a width or a height of 0, and where the "size of an array file differs from width * height + 4 bytes"; the place is
/// the file and the byte.
Result<ThesisArray> read_thesis_array(std::span<const std::byte> bytes, const std::string& name);

/// The bytes of such a file. Error: `malformed_value` for an array without cells, or with another number of them than
/// its width and height say.
Result<std::vector<std::byte>> write_thesis_array(const ThesisArray& array);

/// "A movie file is a list of names, separated by carriage returns or newlines. Each name is the filename" of a
/// "workspace file in the same directory as the movie file."
struct ThesisMovie {
  /// The most frames that the thesis's Sandpaper holds ("Implementation Limits").
  static constexpr std::size_t most_frames = 100;

  std::vector<std::string> workspaces;  ///< UTF-8, in order; one may be there several times

  friend bool operator==(const ThesisMovie&, const ThesisMovie&) = default;
};

/// Reads a movie; lines end as on any system, and empty ones count for nothing. Errors: `damaged_file` for a file that
/// has no name or holds something else, with its line; `invalid_encoding` for one that is not UTF-8; `too_long` beyond
/// 4 MB.
Result<ThesisMovie> read_thesis_movie(std::string_view text, const std::string& name);

/// The text of such a file, with newlines. Errors: `malformed_value` for a movie without frames or with more than
/// `most_frames`, and for a name that is empty, blank or of several lines.
Result<std::string> write_thesis_movie(const ThesisMovie& movie);

/// A shuffle: "Movie:<filename> Date: <date> Time: <time>", a blank line, and then "one line for each frame of the
/// movie. Each line is an integer, whitespace, and a name."
struct ThesisShuffle {
  struct Frame {
    std::size_t original = 0;  ///< its place before the shuffle, from 0
    std::string name;          ///< UTF-8, of "the workspace file that was at that position in the movie file, after the shuffle"

    friend bool operator==(const Frame&, const Frame&) = default;
  };
  std::string movie, date, time;  ///< as written: the thesis prints no form of date and time
  /// What the first place is called in the file, 0 or 1: the thesis does not say. Reading finds it in the numbers.
  unsigned first_number = 1;
  std::vector<Frame> frames;  ///< in the order after the shuffle

  friend bool operator==(const ThesisShuffle&, const ThesisShuffle&) = default;
};

/// Reads a shuffle. Errors: `damaged_file` for a missing part of the header, a line that is no number and name, a number
/// that is there twice, or numbers that are not the places of so many frames, with the line; `invalid_encoding`;
/// `too_long` beyond 4 MB.
Result<ThesisShuffle> read_thesis_shuffle(std::string_view text, const std::string& name);

/// The text of such a file, with newlines. Error: `malformed_value` for one that would not be read as the same value.
Result<std::string> write_thesis_shuffle(const ThesisShuffle& shuffle);

/// The shuffle that gives the frames of a movie another order; of frames that are there several times, the first comes
/// from the first place. The caller fills in `movie`, `date` and `time`. Error: `malformed_value` where the two do not have
/// the same frames.
Result<ThesisShuffle> shuffle_of(const ThesisMovie& movie, const ThesisMovie& shuffled);

/// What a file of the thesis holds, as far as its name and its bytes tell.
enum class ThesisFileKind {
  surface,    ///< its name ends in ".depth": an array of heights
  shading,    ///< its name ends in ".shade": an array of luminance
  array,      ///< an array or a wave: nothing but its author's word tells which
  wave,       ///< its name ends in ".wave"
  shuffle,    ///< it begins with "Movie:"
  movie,      ///< another text
  workspace,  ///< binary, and perhaps a workspace: not read
};
ThesisFileKind kind_of_thesis_file(std::string_view name, std::string_view bytes);

/// The error for a file of kind `workspace`: what is not known of it, and what to do instead.
Error unread_thesis_workspace(const std::string& name);

/// A file that belongs beside the Wale text that names it.
struct FileBeside {
  std::string name;
  std::string bytes;

  friend bool operator==(const FileBeside&, const FileBeside&) = default;
};

/// What becomes of a file of the thesis: declarations, which end with a newline and stand behind `wale 1`.
struct ThesisInWale {
  std::string name;  ///< of the material or the movie
  std::string text;
  std::vector<FileBeside> files = {};
  std::string note = {};  ///< what of the options it has no use for; mostly empty
};

/// A name of the language for a file's name, "grid_3" for "grid 3.depth", that is not among `taken`.
std::string wale_name(std::string_view file_name, const std::set<std::string>& taken);

/// The side of a cell of an array, in m: "Arrays are sampled at a resolution of one screen pixel per array item"
/// (Appendix B, 2.1), and "1 pixel = .37 mm" (figure 11).
inline constexpr double thesis_cell = 0.37e-3;

/// What a surface map needs to be felt.
struct ThesisSurfaceOptions {
  std::string name;         ///< of the material, a name of the language
  std::string file;         ///< of the thesis, for its documentation
  /// N, the amplitude of the lateral force. The thesis's force is "k(h(x+1) - h(x-1))" (equation 12), and no k is printed:
  /// nothing but its author's word tells how hard an array pushes.
  double amplitude = 0;
  double cell = thesis_cell;  ///< m, an array's; a wave has none
  /// m, a wave's: its width is one period. "Waves patches are surface maps that are sampled at variable resolution", so
  /// its file does not tell.
  double period = 0;
};

/// An array as a material: its relief is the array, its size one cell for each pixel of the thesis's screen; the picture
/// beside it (`NAME.pgm`) has its bytes. The first row is uppermost and heights push downhill; force is level between
/// black and white alike, a smooth spline of the cells. With a `shading` of the same size its picture is that one.
/// Errors: `malformed_value` for figures that are not positive; `image_size` for fewer than 4 by 4 cells, more than 2^24,
/// or a shading of another size.
Result<ThesisInWale> surface_in_wale(const ThesisArray& surface, const ThesisSurfaceOptions& options,
                                     const ThesisArray* shading = nullptr);

/// A wave as a material with that waveform, again and again, whose period is a parameter. Its columns are one period; if
/// its rows differ, they repeat too, with cells as high as wide. Errors as above; `image_size` for more than 4000 cells
/// in a side.
Result<ThesisInWale> wave_in_wale(const ThesisArray& wave, const ThesisSurfaceOptions& options);

/// What a movie or a shuffle finds in the file that it comes into.
struct ThesisShowOptions {
  std::string name;                  ///< of the movie, a name of the language
  std::string file;                  ///< of the thesis, for its documentation
  std::set<std::string> workspaces;  ///< that are there: a frame of such a name is that one, also as `wale_name` spells it
  std::set<std::string> taken;       ///< names that a new workspace may not have, besides these
};

/// A movie as a `movie`. A frame that is no workspace yet becomes an empty one, to lay its patches out in: the binary
/// workspace of the thesis is not read. Error: `malformed_value` for a movie without frames.
Result<ThesisInWale> movie_in_wale(const ThesisMovie& movie, const ThesisShowOptions& options);

/// A shuffle as a `movie` whose frames are in the order after the shuffle.
Result<ThesisInWale> shuffle_in_wale(const ThesisShuffle& shuffle, const ThesisShowOptions& options);

/// How a surface is sampled for an array.
struct ThesisSampling {
  std::uint16_t width = 0, height = 0;  ///< cells
  double cell = thesis_cell;            ///< m
  /// m or a plain number, as the relief: the heights of 0 and 255; without them the surface's own least and greatest.
  std::optional<std::pair<double, double>> heights = {};
};

/// The relief of a material as the surface map of an array or a wave, its middle at the patch's centre. Errors:
/// `malformed_value` for a sampling without cells; `image_size` for more than 2^24 of them; `value_out_of_range` for a
/// surface that is not a number somewhere, or beyond `heights`; `flat_height` for a flat surface without `heights`.
Result<ThesisArray> surface_of(const Bank& bank, const ThesisSampling& sampling);

/// The colours of a material (`show colour`) as the visual representation of an array. Errors as above; `flat_height` for
/// a material that shows no colour.
Result<ThesisArray> shading_of(const Bank& bank, const ThesisSampling& sampling);

}  // namespace wale
