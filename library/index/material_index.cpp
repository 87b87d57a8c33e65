#include "library/index/material_index.hpp"

#include <algorithm>
#include <map>
#include <tuple>

#include "library/index/words.hpp"

namespace wale {
namespace {

class IndexInMemory final : public MaterialIndex, WordTable {
 public:
  IndexInMemory(std::vector<Entry> entries, std::string device)
      : entries_(std::move(entries)), device_(std::move(device)), columns_(FeltColumns::of({})) {
    std::vector<FeltRow> rows;
    for (std::uint32_t i = 0; i < entries_.size(); ++i) {
      rows.push_back(felt_row(entries_[i], i));
      const WordCounts counted = count_words(entries_[i]);
      size_.length += counted.length;
      for (const auto& [word, weight] : counted.weights) hits_[word].push_back({i, weight, counted.length});
      for (auto& [by, text] : meant_texts(entries_[i])) meant_[{by, std::move(text)}].push_back(i);
    }
    size_.materials = entries_.size();
    columns_ = FeltColumns::of(rows);
  }

  const WordTable& words() const override { return *this; }
  const FeltColumns& columns() const override { return columns_; }
  std::string device() const override { return device_; }
  Result<Entry> entry(std::uint32_t material) const override { return entries_.at(material); }

  Result<std::vector<std::uint32_t>> meant_by(std::string_view text) const override {
    if (text.empty()) return std::vector<std::uint32_t>{};
    for (const MeantBy by : {MeantBy::name, MeantBy::replaces, MeantBy::called, MeantBy::kind, MeantBy::module})
      if (const auto found = meant_.find({by, meant_text(by, text)}); found != meant_.end()) return found->second;
    return std::vector<std::uint32_t>{};
  }

  Size size() const override { return size_; }
  Result<> each_hit(const std::string& beginning, const Visit& visit) const override {
    for (auto at = hits_.lower_bound(beginning); at != hits_.end() && at->first.starts_with(beginning); ++at)
      for (const WordHit& hit : at->second) visit(at->first, hit);
    return {};
  }

 private:
  std::vector<Entry> entries_;
  std::string device_;
  Size size_;
  std::map<std::string, std::vector<WordHit>> hits_;
  std::map<std::pair<MeantBy, std::string>, std::vector<std::uint32_t>> meant_;
  FeltColumns columns_;
};

}  // namespace

std::string meant_text(MeantBy by, std::string_view text) {
  if (by == MeantBy::module) {  // as in `MODULE:NAME` too
    std::string dotted(text);
    std::ranges::replace(dotted, ':', '.');
    return dotted;
  }
  if (by != MeantBy::called) return std::string(text);
  std::string joined;
  for (const std::string& word : words_of(text)) joined += (joined.empty() ? "" : " ") + word;
  return joined;
}

std::vector<std::pair<MeantBy, std::string>> meant_texts(const Entry& entry) {
  std::vector<std::pair<MeantBy, std::string>> texts;
  const auto add = [&](MeantBy by, std::string_view text) {
    if (std::string meant = meant_text(by, text); !meant.empty()) texts.emplace_back(by, std::move(meant));
  };
  add(MeantBy::name, entry.name);
  for (const std::string& each : entry.replaces) add(MeantBy::replaces, each);
  add(MeantBy::called, entry.title);
  for (const EntryName& each : entry.names) add(MeantBy::called, each.text);
  add(MeantBy::kind, entry.kind);
  add(MeantBy::module, entry.module);
  add(MeantBy::module, entry.module + "." + entry.name);
  std::ranges::sort(texts);
  texts.erase(std::unique(texts.begin(), texts.end()), texts.end());
  return texts;
}

std::unique_ptr<MaterialIndex> index_of(std::vector<Entry> entries, std::string device) {
  return std::make_unique<IndexInMemory>(std::move(entries), std::move(device));
}

}  // namespace wale
