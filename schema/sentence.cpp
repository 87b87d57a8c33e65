#include "schema/sentence.hpp"

#include <sstream>

#include "schema/as_people_write.hpp"

namespace wale {
namespace {

template <typename Number>
std::string streamed(Number number) {
  std::ostringstream text;
  text << number;
  return text.str();
}

}  // namespace

void SentencePart::append_to(std::string& sentence) const {
  switch (kind_) {
    case Kind::text: sentence += text_; return;
    case Kind::quantity: sentence += as_people_write(streamed(quantity_), quantity_, Digits::grouped); return;
    case Kind::integer:
      sentence += as_people_write(streamed(integer_), static_cast<double>(integer_), Digits::together);
      return;
    case Kind::count:
      sentence += as_people_write(streamed(count_), static_cast<double>(count_), Digits::together);
      return;
  }
}

std::string sentence_of(std::initializer_list<SentencePart> parts) {
  std::string sentence;
  for (const SentencePart& part : parts) part.append_to(sentence);
  return sentence;
}

void fail_with(Code code, std::initializer_list<SentencePart> parts) {
  throw Error{.code = code, .sentence = sentence_of(parts)};
}

}  // namespace wale
