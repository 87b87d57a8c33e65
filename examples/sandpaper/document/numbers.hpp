#pragma once

#include <QObject>
#include <map>
#include <random>
#include <set>
#include <utility>

#include "document/document.hpp"

namespace sandpaper {

/// Random numbers for the names of patches, of three digits while there are fewer than 900: "regenerated for each
/// patch, for each session" (Minsky 1995, Appendix B). A patch keeps its number while it is in its workspace under its
/// name, also when other workspaces are shown in between. They follow from the seed and from the order in which patches
/// come. In the window's thread.
class Numbers : public QObject {
  Q_OBJECT

 public:
  /// With numbers of its own for each one.
  explicit Numbers(const Document& document, QObject* parent = nullptr);

  /// New numbers, in the order of the document.
  void renew(std::uint32_t seed);
  std::uint32_t seed() const { return seed_; }
  QString of(const Placed& placed) const;

 signals:
  void renewed();

 private:
  void follow();

  const Document& document_;
  std::uint32_t seed_ = 0;
  std::mt19937 random_;
  std::map<std::pair<std::string, std::string>, std::uint32_t> known_;  // by workspace and patch
  std::set<std::uint32_t> taken_;
};

}  // namespace sandpaper
