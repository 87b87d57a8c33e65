#include "wale/error.h"

#include "runtime/c/sized.hpp"

using namespace wale::c;

namespace {

struct CodeRow {
  WaleCode code;
  std::string_view name, title;
  int32_t severity;
};

constexpr CodeRow code_rows[] = {
#define WALE_CODE(number, name, severity, title) {1##number - 10000, "W" #number, title, WALE_SEVERITY_##severity},
#include "wale/codes.def"
};

const CodeRow* row_of(WaleCode code) noexcept {
  for (const CodeRow& each : code_rows)
    if (each.code == code) return &each;
  return nullptr;
}

template <class Number>
int64_t or_none(const std::optional<Number>& number) {
  return number ? static_cast<int64_t>(*number) : -1;
}

}  // namespace

void wale_error_free(WaleError* error) { free_handle(error); }

WaleCode wale_error_code(const WaleError* error) {
  return error == nullptr ? 0 : static_cast<WaleCode>(error->error.code);
}

WaleCode wale_error_details(const WaleError* error, WaleErrorDetails* details) {
  if (error == nullptr || !has_size(details)) return WALE_CODE_malformed_value;
  const wale::Error& wrong = error->error;
  write_sized(details, {.code = static_cast<WaleCode>(wrong.code),
                        .severity = wale_code_severity(static_cast<WaleCode>(wrong.code)),
                        .sentence = text_of(wrong.sentence),
                        .mend = text_of(wrong.mend),
                        .expected = text_of(wrong.expected),
                        .found = text_of(wrong.found),
                        .place = text_of(wrong.place.name),
                        .place_text = text_of(wrong.place.text),
                        .place_source = text_of(wrong.place.source),
                        .number = or_none(wrong.place.number),
                        .column = or_none(wrong.place.column),
                        .length = wrong.place.length,
                        .in_words = text_of(error->in_words),
                        .explained = text_of(error->explained),
                        .nearest = wrong.nearest.size(),
                        .others = error->others.size()});
  return 0;
}

WaleText wale_error_nearest(const WaleError* error, size_t index) {
  if (error == nullptr || index >= error->error.nearest.size()) return text_of({});
  return text_of(error->error.nearest[index]);
}

const WaleError* wale_error_other(const WaleError* error, size_t index) {
  if (error == nullptr || index >= error->others.size()) return nullptr;
  return error->others[index].get();
}

WaleText wale_code_name(WaleCode code) {
  const CodeRow* row = row_of(code);
  return row == nullptr ? text_of({}) : text_of(row->name);
}

WaleText wale_code_title(WaleCode code) {
  const CodeRow* row = row_of(code);
  return row == nullptr ? text_of({}) : text_of(row->title);
}

int32_t wale_code_severity(WaleCode code) {
  const CodeRow* row = row_of(code);
  return row == nullptr ? WALE_SEVERITY_error : row->severity;
}

WaleText wale_version(void) { return text_of(WALE_VERSION); }

int32_t wale_interface(void) { return WALE_INTERFACE; }
