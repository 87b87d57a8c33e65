#pragma once

#include <QObject>
#include <glm/vec2.hpp>
#include <map>
#include <optional>
#include <vector>
#include <wale/compiled_workspace.hpp>

#include "document/placed.hpp"
#include "presenting/session.hpp"

namespace sandpaper {

/// A patch as a key on the sorting table.
struct SortingKey {
  std::uint64_t id = 0;  ///< of the patch
  std::string name;
  QString label;     ///< what is written on it
  glm::dvec2 at{0};  ///< m, its centre on the table, whose origin is the workspace's centre
  int pile = 0;      ///< the number of its pile, from 1; 0: it lies alone
};

/// Sorting the patches of a workspace by mini-keys: which key is chosen, and which lie in one pile. Each change is
/// an answer, which is logged before it is made. In the window's thread.
class Sorting : public QObject {
  Q_OBJECT

 public:
  explicit Sorting(Session& session, QObject* parent = nullptr) : QObject(parent), session_(session) {}

  /// Lays the keys of the patches out at random places, with random labels if the declaration says so; both follow from
  /// the seed. False if the order cannot be logged, or no patch can be a key.
  bool start(const wale::MiniKeys& declared, const Contents& contents, std::uint32_t seed);
  void stop();
  bool runs() const { return !keys_.empty(); }

  const wale::MiniKeys& declared() const { return declared_; }
  const std::vector<SortingKey>& keys() const { return keys_; }
  const SortingKey* chosen() const { return chosen_ ? &keys_[*chosen_] : nullptr; }
  std::optional<std::size_t> chosen_index() const { return chosen_; }
  double side() const { return declared_.key.value_or(0.025); }  ///< m, of a key
  glm::dvec2 table() const { return table_; }                    ///< m, width and height
  glm::dvec2 area_at() const { return {declared_.at[0], declared_.at[1]}; }
  glm::dvec2 area_size() const { return {declared_.area[0], declared_.area[1]}; }
  /// The numbers of the piles, in their order.
  std::vector<int> piles() const;
  QString says(int pile) const;
  std::optional<std::size_t> key_at(glm::dvec2 metres) const;  ///< the last one drawn at a place

  void choose(std::size_t key);
  /// Moves a key without an answer: it lies where it was dropped.
  void move(std::size_t key, glm::dvec2 to);
  /// Puts a key into a pile: 0 takes it out; a number that no pile has begins one.
  void put(std::size_t key, int pile);
  /// Puts a key where another one lies: into its pile, or both into a new one.
  void put_on(std::size_t key, std::size_t other);
  /// Puts all keys of a pile into another one.
  void join(int pile, int into);
  void label(int pile, const QString& says);
  /// Takes the last answer back, which can be several lines of the log. It can be called again and again.
  void take_back();
  bool can_take_back() const { return !steps_.empty(); }
  int new_pile() const;  ///< a number that no pile has

  /// The piles as they are now; keys that lie alone are in none.
  std::vector<wale::SortedGroups::Group> groups() const;

 signals:
  void changed();
  void chosen_changed();

 private:
  struct Step {
    std::vector<SortingKey> keys;
    std::map<int, QString> says;
    std::vector<std::uint64_t> answers;
  };
  /// Logs the answers and keeps what was before; false if they cannot be logged. `begun` is a pile that they begin.
  bool answer(std::vector<wale::SessionAnswer> answers, int begun = 0);
  wale::SessionAnswer in_pile(std::size_t key, int pile) const;
  void tidy(int pile);  ///< lays its keys side by side
  void lay_out();       ///< tells the session where the keys lie

  Session& session_;
  wale::MiniKeys declared_;
  std::vector<SortingKey> keys_;
  std::map<int, QString> says_;
  std::optional<std::size_t> chosen_;
  std::vector<Step> steps_;
  glm::dvec2 table_{0.3, 0.2};
};

/// `groups NAME { … }` in the standard style, without a newline at its end.
std::string groups_text(const wale::SortedGroups& groups);

}  // namespace sandpaper
