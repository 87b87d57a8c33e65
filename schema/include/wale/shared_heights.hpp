#pragma once

#include <cstdint>
#include <initializer_list>
#include <memory>
#include <utility>
#include <vector>

namespace wale {

/// The codes of a height table: a vector whose copies share memory until one of them changes, so that ten thousand
/// programs with one map hold it once. As with a vector, several threads may read it at once.
class SharedHeights {
 public:
  using Codes = std::vector<std::uint16_t>;
  using value_type = Codes::value_type;
  using iterator = Codes::iterator;
  using const_iterator = Codes::const_iterator;

  SharedHeights() = default;
  SharedHeights(Codes codes) : codes_(std::make_shared<Codes>(std::move(codes))) {}
  SharedHeights(std::initializer_list<std::uint16_t> codes) : SharedHeights(Codes(codes)) {}

  operator const Codes&() const { return codes(); }
  std::size_t size() const { return codes().size(); }
  bool empty() const { return codes().empty(); }
  const std::uint16_t* data() const { return codes().data(); }
  const_iterator begin() const { return codes().begin(); }
  const_iterator end() const { return codes().end(); }
  std::uint16_t operator[](std::size_t i) const { return codes()[i]; }

  // Functions that change codes first copy them if they are shared, in time proportional to their number.
  iterator begin() { return own().begin(); }
  iterator end() { return own().end(); }
  std::uint16_t& operator[](std::size_t i) { return own()[i]; }
  void push_back(std::uint16_t code) { own().push_back(code); }
  void pop_back() { own().pop_back(); }
  void reserve(std::size_t count) { own().reserve(count); }
  void resize(std::size_t count) { own().resize(count); }

  /// Whether both share their memory.
  bool shares(const SharedHeights& other) const { return codes_ == other.codes_; }
  friend bool operator==(const SharedHeights& one, const SharedHeights& other) {
    return one.shares(other) || one.codes() == other.codes();
  }

 private:
  const Codes& codes() const {
    static const Codes none;
    return codes_ ? *codes_ : none;
  }
  Codes& own() {
    if (!codes_) {
      codes_ = std::make_shared<Codes>();
    } else if (codes_.use_count() > 1) {
      codes_ = std::make_shared<Codes>(*codes_);
    }
    return *codes_;
  }

  std::shared_ptr<Codes> codes_;
};

}  // namespace wale
