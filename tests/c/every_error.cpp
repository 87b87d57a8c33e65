// Calls each function of the C interface with arguments by chance, right and wrong ones, and looks at each error that
// comes back: it has a code, a sentence, a place, and what to do about it. every_function.def, which the build makes
// from the headers, names all functions that can fail; one with a new type of argument does not compile until `draw`
// knows the type.
//
// test_every_error [TIMES [SEED [THREADS]]]. With threads, each draws its own arguments and now and then takes handles
// that all of them use, those that may be used by any thread at the same time.
#include <unistd.h>
#include <wale.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <random>
#include <set>
#include <string>
#include <thread>
#include <tuple>
#include <vector>

namespace {

thread_local std::mt19937 chance(1995);

std::size_t below(std::size_t end) { return std::uniform_int_distribution<std::size_t>(0, end - 1)(chance); }
template <class Value>
Value one_of(std::initializer_list<Value> all) {
  return all.begin()[below(all.size())];
}
bool seldom() { return below(8) == 0; }

/// Handles that earlier calls gave, and the place for the next one.
template <class Handle>
thread_local std::vector<Handle*> made;
template <class Handle>
thread_local Handle* given = nullptr;
template <class Handle>
void (*freed_by)(Handle*) = nullptr;
/// Handles that all threads use, and none frees.
template <class Handle>
std::vector<Handle*> shared;

template <class Handle>
void keep_given() {
  if (given<Handle> != nullptr) made<Handle>.push_back(given<Handle>);
  given<Handle> = nullptr;
  constexpr std::size_t enough = 12;
  if (made<Handle>.size() <= enough) return;
  const std::size_t gone = below(made<Handle>.size());
  freed_by<Handle>(made<Handle>[gone]);
  made<Handle>.erase(made<Handle>.begin() + static_cast<std::ptrdiff_t>(gone));
}

#define EVERY_HANDLE(DO)                                                                                             \
  DO(WaleLibrary, library)                                                                                           \
  DO(WaleFuture, future)                                                                                             \
  DO(WaleProgram, program) DO(WaleDevices, devices) DO(WaleDevice, device) DO(WaleStage, stage) DO(WalePatch, patch) \
      DO(WaleEdit, edit) DO(WaleLoop, loop) DO(WaleRun, run) DO(WaleFelt, felt) DO(WaleShape, shape)                 \
          DO(WaleSnapshot, snapshot) DO(WaleRecording, recording) DO(WaleWorkspace, workspace) \
          DO(WaleMatches, matches) DO(WalePlacement, placement)

std::string folder;                                    // for files
std::vector<std::string> paths, texts;                 // of files, and for names
alignas(16) thread_local unsigned char room[1 << 16];  // for arrays
thread_local bool has_array = false;                   // the function has one: its lengths are small

template <class Handle>
void draw_handle(Handle*& to) {
  if (!shared<Handle>.empty() && below(2) == 0) {
    to = shared<Handle>[below(shared<Handle>.size())];
    return;
  }
  to = seldom() || made<Handle>.empty() ? nullptr : made<Handle>[below(made<Handle>.size())];
}
#define DRAW_HANDLE(Handle, name)                              \
  [[maybe_unused]] void draw(Handle*& to) { draw_handle(to); } \
  [[maybe_unused]] void draw(const Handle*& to) {              \
    Handle* chosen = nullptr;                                  \
    draw_handle(chosen);                                       \
    to = chosen;                                               \
  }                                                            \
  void draw(Handle**& to) { to = below(20) == 0 ? nullptr : &given<Handle>; }
EVERY_HANDLE(DRAW_HANDLE)

WaleText text_of(const std::string& text) { return {text.data(), text.size()}; }

void draw(WaleText& to) {
  to = text_of(below(4) == 0 ? paths[below(paths.size())] : texts[below(texts.size())]);
  if (below(30) == 0) to = {nullptr, 5};
  if (below(30) == 0) to.length = SIZE_MAX - 1;
}
void draw(std::size_t& to) {
  to = has_array ? one_of<std::size_t>({0, 1, 3, 8, 64}) : one_of<std::size_t>({0, 0, 1, 7, 100000, SIZE_MAX});
}
thread_local bool asks_for_infinity = false;
void draw(double& to) {
  to = one_of({0.0, 0.001, 0.0025, 0.01, 1.0, -1.0, 1e300, double(NAN), double(INFINITY)});
  if (to > 1e300) asks_for_infinity = true;
}
void draw(float& to) { to = one_of({0.0f, 0.01f, 0.01f, 0.05f, 1.0f, -1.0f, 1e30f, NAN, float(INFINITY)}); }
void draw(std::int32_t& to) { to = one_of<std::int32_t>({0, 0, 1, 1, 2, -1, 77}); }
void draw(WaleVector& to) { draw(to.x), draw(to.y); }
void draw(WaleReceiveContact& to) {
  to = nullptr;
  if (below(2)) to = [](const WaleContact*, void*) {};
}

template <class Element>
void draw_array(Element*& to) {
  to = seldom() ? nullptr : reinterpret_cast<Element*>(room);
}
#define DRAW_ARRAY(Element) \
  [[maybe_unused]] void draw(Element*& to) { draw_array(to); }
DRAW_ARRAY(void)
DRAW_ARRAY(const void)
DRAW_ARRAY(WaleVector) DRAW_ARRAY(const WaleVector) DRAW_ARRAY(float) DRAW_ARRAY(const std::uint8_t)
    DRAW_ARRAY(std::size_t) DRAW_ARRAY(WaleMark) DRAW_ARRAY(WaleTick) DRAW_ARRAY(WaleRecordedTick)

    /// A struct with a size for a result.
    template <class Struct>
    void draw_result(Struct*& to) {
  static thread_local Struct place;
  place.size = below(6) == 0 ? one_of<std::size_t>({0, 3, 1 << 20}) : sizeof place;
  to = seldom() ? nullptr : &place;
}
#define DRAW_RESULT(Struct) \
  void draw(Struct*& to) { draw_result(to); }
DRAW_RESULT(WaleDeviceInfo)
DRAW_RESULT(WaleProfile)
DRAW_RESULT(WaleProgramDetails) DRAW_RESULT(WaleParameter) DRAW_RESULT(WalePercept) DRAW_RESULT(WaleRecordingDetails)
    DRAW_RESULT(WaleFate) DRAW_RESULT(WaleReplay) DRAW_RESULT(WaleRunFigures) DRAW_RESULT(WaleFeltFigures) DRAW_RESULT(WaleFeltLevel)
        DRAW_RESULT(WaleGrid) DRAW_RESULT(WaleWorkspaceDetails) DRAW_RESULT(WaleWorkspacePatch)
            DRAW_RESULT(WaleWorkspaceMark) DRAW_RESULT(WaleMatch) DRAW_RESULT(WalePlacementDetails)

    /// Options: mostly all 0, with some fields set by `set`.
    template <class Struct, class Set>
    void draw_options(const Struct*& to, const Set& set) {
  static thread_local struct {
    Struct known;
    double newer;
  } place;
  std::memset(&place, 0, sizeof place);
  place.known.size = below(10) == 0 ? one_of<std::size_t>({0, 3, 1 << 20}) : sizeof(Struct);
  if (below(15) == 0) place.known.size = sizeof place, place.newer = 1;
  for (std::size_t i = below(3); i > 0; --i) set(place.known);
  to = seldom() ? nullptr : &place.known;
}
/// Draws one of these fields.
template <class... Field>
void draw_field(Field&... fields) {
  std::size_t chosen = below(sizeof...(fields)), i = 0;
  ((i++ == chosen ? draw(fields) : void()), ...);
}

void draw(const WaleDeviceOptions*& to) {
  draw_options(to, [](WaleDeviceOptions& its) {
    draw_field(its.built_for, its.transport, its.max_force, its.priority, its.disregard_owner, its.hand_mass,
               its.hand_damping, its.hand_stiffness, its.motion, its.reserved, its.amplitude, its.frequency,
               its.centre_x, its.direction_y, its.count);
    if (its.count > 64) its.count = 64;
    if (below(2)) its.points = reinterpret_cast<const double*>(room);
  });
}
void draw(const WaleStageOptions*& to) {
  draw_options(to, [](WaleStageOptions& its) {
    draw_field(its.priority, its.low_latency, its.reserved, its.max_force, its.record_hand, its.record);
    if (below(3) == 0) its.record = text_of(paths[below(paths.size())]);
  });
}
void draw(const WalePatchOptions*& to) {
  draw_options(to, [](WalePatchOptions& its) {
    draw_field(its.x, its.y, its.width, its.height, its.rim, its.layer, its.shape);
  });
}
void draw(const WaleRunOptions*& to) {
  draw_options(to, [](WaleRunOptions& its) {
    its.seconds = one_of({0.01, 0.01, 0.01, 0.0, -1.0, 1e9, double(NAN)});
    if (its.seconds < 1) draw_field(its.kept_seconds, its.virtual_time, its.reserved);
  });
}
void draw(const WaleMeasureOptions*& to) {
  draw_options(to, [](WaleMeasureOptions& its) { draw_field(its.settling, its.stuck_seconds, its.stuck_counts); });
}
/// A search by feel in it says what is wrong: the library would take too long to be read here.
std::string no_index;
WaleLibraryOptions with_no_index() {
  WaleLibraryOptions its{};
  its.size = sizeof its, its.index = text_of(no_index);
  return its;
}
void draw(const WaleLibraryOptions*& to) {
  static thread_local WaleText folders[2];
  static const WaleLibraryOptions usual = with_no_index();
  draw_options(to, [](WaleLibraryOptions& its) {
    its.index = text_of(no_index);
    for (WaleText& each : folders) draw(each);
    if (below(2)) folders[0] = folders[1] = text_of(folder);
    if (below(2)) its.folders = folders;
    draw_field(its.unsandboxed_pictures, its.reserved, its.folder_count, its.devices);
    if (its.folder_count > 2) its.folder_count = 2;
  });
  if (to == nullptr || (to->size == sizeof *to && to->index.length == 0)) to = &usual;
}
void draw(const WaleCompileOptions*& to) {
  draw_options(to, [](WaleCompileOptions& its) { draw_field(its.device, its.material, its.name); });
}
void draw(const WaleSearchOptions*& to) {
  static thread_local WalePerceptRange range;
  draw_options(to, [](WaleSearchOptions& its) {
    draw(range.percept), draw(range.low), draw(range.high);
    if (below(3) == 0) its.percepts = &range, its.percept_count = 1;
    draw_field(its.kind, its.near, its.most, its.device);
  });
}
void draw(const WaleWorkspaceOptions*& to) {
  draw_options(to, [](WaleWorkspaceOptions& its) {
    draw_field(its.device, its.workspace, its.name, its.legibility, its.reserved);
  });
}
void draw(const WaleProfile*& to) {
  draw_options(to, [](WaleProfile& its) {
    WaleProfile known{};
    known.size = sizeof known;
    if (wale_profile(text_of(one_of<std::string>({"sandpaper", "falcon"})), &known, nullptr) == 0) its = known;
    if (below(2)) draw_field(its.name, its.rate, its.force, its.mass, its.vibrates, its.velocity_window);
  });
}
void draw(const WaleBatchOptions*& to) {
  static thread_local WaleSetting setting;
  draw_options(to, [](WaleBatchOptions& its) {
    its.hands = its.ticks = below(5), its.position = reinterpret_cast<const WaleVector*>(room);
    draw(setting.name), draw(setting.value);
    if (below(2)) its.settings = &setting, its.setting_count = 1;
    draw_field(its.position, its.width, its.height, its.rim, its.reserved);
  });
}

thread_local WaleError* error = nullptr;
void draw(WaleError**& to) { to = &error; }

thread_local std::map<WaleCode, int> seen;
std::atomic<int> failures = 0;

/// Whether an error tells its reader enough. Looks at its others too.
void look_at(const char* function, const WaleError* wrong, WaleCode code) {
  WaleErrorDetails told{};
  told.size = sizeof told;
  const auto fail = [&](const char* lacks) {
    std::fprintf(stderr, "%s: W%04d has no %s: %s\n", function, code, lacks, told.in_words.data);
    ++failures;
  };
  if (wale_error_code(wrong) != code || wale_error_details(wrong, &told) != 0) return fail("matching code");
  const auto holds = [](WaleText text, WaleText part) {
    return std::string(text.data, text.length).find(std::string(part.data, part.length)) != std::string::npos;
  };
  if (wale_code_name(code).length == 0) fail("name of its code");
  if (told.sentence.length == 0) fail("sentence");
  if (told.mend.length == 0 && told.nearest == 0) fail("mend, and no near name");
  if (code == WALE_CODE_malformed_value && told.place.length == 0) fail("argument");
  if ((code == WALE_CODE_unreadable_file || code == WALE_CODE_unwritable_file) && told.place.length == 0) fail("file");
  if (!holds(told.in_words, told.sentence) || !holds(told.in_words, told.mend)) fail("sentence in its words");
  // Words are for a terminal: what is no plain text stands in them in another form.
  const auto is_plain = [](WaleText text) {
    return std::all_of(text.data, text.data + text.length, [](unsigned char c) { return c >= 0x20 && c < 0x7f; });
  };
  if (is_plain(told.place) && !holds(told.in_words, told.place)) fail("place in its words");
  if (std::any_of(told.in_words.data, told.in_words.data + told.in_words.length,
                  [](unsigned char c) { return (c < 0x20 && c != '\n') || c == 0x7f; }))
    fail("words that a terminal shows");
  if (std::strchr(told.in_words.data, '\n') && !std::strchr(told.mend.data, '\n')) fail("words in one line");
  if (told.column >= 0 && (told.column < 1 || told.number < 1)) fail("line and column");
  if (std::string(told.place.data, told.place.length).find(".wale") != std::string::npos && code / 100 < 5 &&
      told.column < 1)
    fail("column in its Wale file");
  if (!asks_for_infinity && std::strstr(told.in_words.data, "inf ") != nullptr) fail("number that was asked for");
  for (std::size_t i = 0; i < told.others; ++i) {
    const WaleError* other = wale_error_other(wrong, i);
    if (wale_error_code(other) == 0) fail("code of another error");
  }
}

void note(const char* function, WaleCode code) {
  if ((code != 0) != (error != nullptr))
    std::fprintf(stderr, "%s: code %d and error %p\n", function, code, static_cast<void*>(error)), ++failures;
  if (error != nullptr) look_at(function, error, code);
  if (code != 0) ++seen[code];
  wale_error_free(error);
  error = nullptr;
#define KEEP(Handle, name) keep_given<Handle>();
  EVERY_HANDLE(KEEP)
}

template <class Type>
constexpr bool is_array = std::is_pointer_v<Type> &&
                          (std::is_same_v<std::remove_cv_t<std::remove_pointer_t<Type>>, void> ||
                           std::is_same_v<Type, const WaleVector*> || std::is_same_v<Type, const std::uint8_t*> ||
                           std::is_same_v<Type, WaleMark*> || std::is_same_v<Type, WaleTick*> ||
                           std::is_same_v<Type, WaleRecordedTick*>);

template <class... Arguments>
void try_once(const char* name, WaleCode (*function)(Arguments...)) {
  has_array = (is_array<Arguments> || ...);
  asks_for_infinity = false;
  std::tuple<Arguments...> drawn{};
  std::apply([](auto&... each) { (draw(each), ...); }, drawn);
  note(name, std::apply(function, drawn));
}

/// Programs of which some bytes are others.
void try_damaged_programs(const std::string& good) {
  for (int i = 0; i < 300; ++i) {
    std::string bytes = good.substr(0, below(3) ? good.size() : below(good.size()));
    for (std::size_t k = below(3); k > 0 && !bytes.empty(); --k)
      bytes[below(bytes.size())] ^= static_cast<char>(1 << below(8));
    note("wale_program_load", wale_program_load(bytes.data(), bytes.size(), &given<WaleProgram>, &error));
    note("wale_library_open_bytes", wale_library_open_bytes(made<WaleLibrary>[0], bytes.data(), bytes.size(), nullptr,
                                                            &given<WaleProgram>, &error));
  }
}

void write(const std::string& name, const std::string& bytes) {
  std::filesystem::create_directories(std::filesystem::path(folder + "/" + name).parent_path());
  std::ofstream(folder + "/" + name, std::ios::binary) << bytes;
  paths.push_back(folder + "/" + name);
}

void prepare() {
  char name[] = "/tmp/wale_every_error_XXXXXX";
  folder = mkdtemp(name);
  if (chdir(folder.c_str()) != 0) std::abort();
  no_index = folder + "/good.wale";
  setenv("XDG_CONFIG_HOME", (folder + "/config").c_str(), 1);
  texts = {"",
           " ",
           "a\nb",
           "\xff",
           std::string("a\0b", 3),
           "corduroy",
           // One patch: the array of patches has room for one.
           "wale 1\nworkspace w { patch a = corduroy { mark roughness, low 0.2 } }\n",
           "corderoy",
           "fabric",
           "mesh",
           "roughness",
           "rougness",
           "coarse",
           "coarze",
           "0.5",
           "2",
           "nothing such",
           "simulated",
           "sandpaper",
           "falcon",
           "falcom",
           "simulated:falcon",
           "simulated:x",
           "1-99",
           "1209:fff1",
           "hidraw",
           "wale",
           "fabric.woven",
           "fabric.denim:denim",
           "denim:",
           "",
           std::string(3000, 'x'),
           "wale 1\nmaterial m {\n  physical { force = 1 + nothing }\n}\n",
           "wale 1\nmaterial m { physical { force = 3 m } }",
           "wale 2\n",
           "material",
           "wale 1\nimport no.where\n",
           "wale 1\nmaterial a { perceptual { roughness 7 } }"};
  write("broken.wale", texts[31]);
  write("good.wale", "wale 1\nmaterial good { perceptual { roughness 0.5 } }\n");
  write("picture.wale", "\x89PNG\r\n\x1a\n");
  write("short.wpp", "\x89WPP\r\n\x1a\n");
  write("short.wrec", "\x89WREC");
  write("new.wrec", "");
  std::filesystem::remove(folder + "/new.wrec");
  paths.push_back(folder);
  paths.push_back(folder + "/missing/x.wale");
  paths.push_back("");
}

void owner_declares(const std::string& text) {
  write("config/wale/devices.wale", text);
  for (WaleLibrary* each : made<WaleLibrary>) wale_library_free(each);
  made<WaleLibrary>.clear();
  const WaleLibraryOptions its = with_no_index();
  note("wale_library_create", wale_library_create(&its, &given<WaleLibrary>, &error));
}

void try_all() {
#define FUNCTION(name) try_once(#name, name);
#include "every_function.def"
}

void free_all() {
#define FREE_ALL(Handle, name)                                        \
  for (Handle * each : made<Handle>) wale_##name##_free(each);        \
  made<Handle>.clear();
  EVERY_HANDLE(FREE_ALL)
}

/// Some of the handles that this thread has made become those of all threads.
template <class Handle>
void share() {
  shared<Handle>.swap(made<Handle>);
}
/// They are this thread's again.
template <class Handle>
void take_back() {
  made<Handle>.insert(made<Handle>.end(), shared<Handle>.begin(), shared<Handle>.end());
  shared<Handle>.clear();
}
#define MAY_BE_SHARED(DO)                                                                                             \
  DO(WaleLibrary) DO(WaleProgram) DO(WaleDevices) DO(WaleDevice) DO(WaleStage) DO(WalePatch) DO(WaleRun) DO(WaleFelt) \
      DO(WaleShape) DO(WaleRecording) DO(WaleWorkspace) DO(WaleMatches)

/// Several threads call all functions at the same time, also with the same handles.
void try_at_once(int times, int threads, unsigned seed) {
#define SHARE(Handle) share<Handle>();
  MAY_BE_SHARED(SHARE)
  std::vector<std::thread> running;
  for (int i = 0; i < threads; ++i)
    running.emplace_back([times, seed, i] {
      chance.seed(seed + 1 + static_cast<unsigned>(i));
      for (int k = 0; k < times; ++k) try_all();
      free_all();
    });
  for (std::thread& each : running) each.join();
#define TAKE_BACK(Handle) take_back<Handle>();
  MAY_BE_SHARED(TAKE_BACK)
}

}  // namespace

int main(int count, char** arguments) {
  const int times = count > 1 ? std::atoi(arguments[1]) : 60;
  const unsigned seed = count > 2 ? static_cast<unsigned>(std::atoi(arguments[2])) : 1995;
  const int threads = count > 3 ? std::atoi(arguments[3]) : 0;
  chance.seed(seed);
  prepare();
#define FREED(Handle, name) freed_by<Handle> = wale_##name##_free;
  EVERY_HANDLE(FREED)
  const WaleLibraryOptions its = with_no_index();
  note("wale_library_create", wale_library_create(&its, &given<WaleLibrary>, &error));
  WaleProgram* corduroy = nullptr;
  if (made<WaleLibrary>.empty() ||
      wale_library_find(made<WaleLibrary>[0], WALE_TEXT("corduroy"), nullptr, &corduroy, nullptr) != 0)
    return std::fprintf(stderr, "no corduroy\n"), 1;
  std::size_t length = 0;
  wale_program_bytes(corduroy, nullptr, 0, &length, nullptr);
  std::string bytes(length, '\0');
  wale_program_bytes(corduroy, bytes.data(), bytes.size(), &length, nullptr);
  write("corduroy.wpp", bytes);
  made<WaleProgram>.push_back(corduroy);
  try_damaged_programs(bytes);

  for (int i = 0; i < times; ++i) {
    if (i == times / 3) owner_declares("wale 1\nexport device mine {\n  force 3 m\n}\n");
    if (i == times / 2) owner_declares("wale 1\nexport device {\n");
    try_all();
  }
  if (threads > 0) try_at_once(times, threads, seed);
  free_all();

  if (wale_handles() != 0) std::fprintf(stderr, "%zu handles are left\n", wale_handles()), ++failures;

  int all = 0;
  for (const auto& [code, often] : seen) all += often, std::printf("%s %d\n", wale_code_name(code).data, often);
  std::printf("%d errors of %zu kinds\n", all, seen.size());
  for (const WaleCode code : {WALE_CODE_malformed_value, WALE_CODE_invalid_encoding, WALE_CODE_unknown_name,
                              WALE_CODE_unknown_device, WALE_CODE_wrong_moment, WALE_CODE_other_device,
                              WALE_CODE_newer_file, WALE_CODE_damaged_file, WALE_CODE_unreadable_file})
    if (seen[code] == 0) std::fprintf(stderr, "never: %s\n", wale_code_name(code).data), ++failures;
  std::filesystem::remove_all(folder);
  return failures != 0;
}
