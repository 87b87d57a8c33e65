#pragma once

#include <QObject>
#include <QStringList>
#include <wale/library.hpp>

#include "document/document.hpp"
#include "document/numbers.hpp"
#include "document/shuffling.hpp"
#include "feeling/feeling.hpp"
#include "presenting/session.hpp"
#include "presenting/sorting.hpp"

namespace sandpaper {

/// Presents a file to a participant: the frames of its movies, shuffled places, and its keys to sort. What is presented
/// is logged first. In the window's thread.
class Presenting : public QObject {
  Q_OBJECT

 public:
  Presenting(const wale::Library& library, Document& document, Numbers& numbers, Feeling& feeling,
             QObject* parent = nullptr);

  Session& session() { return session_; }
  Sorting& sorting() { return sorting_; }
  /// What is to be felt now: the workspace, or while somebody sorts the chosen patch in the touching area.
  Contents felt() const;

  void begin_session(const QString& participant, std::uint32_t seed);
  QStringList movies() const;
  QStringList keys() const;
  void choose_movie(const QString& name);
  /// The movie that is stepped through; empty for all workspaces of the file.
  QString movie() const { return movie_; }
  /// Its frames in the order in which they are shown now, that of the last shuffle or as declared.
  QStringList frames();
  /// The next frame, or the one before, with a beep.
  void step(int by);
  /// Another order of the movie's frames.
  void shuffle_frames();
  /// Another order and other places of the patches, with least overlap.
  void shuffle_places(const SizeOf& size_of);
  /// Whether keys have numbers also where their declaration wants names: with a participant's window.
  void set_hides_names(bool hides) { hides_names_ = hides; }
  /// Begins to sort by keys of that name, or the first ones, as soon as all materials are compiled.
  void start_sorting(const QString& name = {});
  /// Writes the piles into the file, as one step of undo, and into the log.
  void finish_sorting();
  void cancel_sorting(const char* why);
  void recentre();
  void centre_back();
  /// Ends all of it, before another file is opened or the window closes.
  void end(const char* why);

 signals:
  void said(const QString& words);
  void felt_changed();

 private:
  std::optional<wale::Presentation> presentation() const;
  void follow_contents();
  bool log_numbers();
  void log_programs();
  void lay_out();
  void start_if_ready();
  std::string free_name(const std::string& base, const wale::Presentation& taken) const;

  const wale::Library& library_;
  Document& document_;
  Numbers& numbers_;
  Feeling& feeling_;
  Session session_;
  Sorting sorting_;
  QString movie_;
  QStringList order_;  // the shuffled frames; empty: as declared
  qsizetype frame_ = -1;
  bool begins_anew_ = false;  // the next frame is the first one
  bool hides_names_ = false;
  std::string shown_;                       // the workspace that was logged last
  std::map<std::string, std::set<std::string>> numbered_;  // patches whose numbers were logged, by workspaces
  std::optional<wale::MiniKeys> waiting_;  // keys whose materials are still compiled
};

}  // namespace sandpaper
