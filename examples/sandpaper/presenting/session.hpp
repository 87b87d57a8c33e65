#pragma once

#include <QObject>
#include <QTimer>
#include <functional>
#include <map>
#include <optional>
#include <random>
#include <string>
#include <vector>
#include <wale/session_log.hpp>

namespace sandpaper {

/// A patch with its program, as a log tells it.
struct PatchToLog {
  std::string patch, material;       ///< its name, and its material as written
  const wale::Program* program = nullptr;
};

/// The session that runs, if one does, and its log. Without one everything can be presented, and nothing is logged. In
/// the window's thread.
class Session : public QObject {
  Q_OBJECT

 public:
  explicit Session(QObject* parent = nullptr);

  /// Begins a log beside the file that is presented: `kitchen-S48-1.session`, or the next number that is free. Error:
  /// as `wale::SessionLog::create`, or that the file is not saved yet. Then a session that ran before goes on.
  wale::Result<> begin(const QString& participant, std::uint32_t seed, const QString& file, const QString& device);
  void end(const char* why);
  bool runs() const { return log_.has_value(); }
  QString path() const { return log_ ? QString::fromStdString(log_->path()) : QString(); }
  QString participant() const { return participant_; }
  std::uint32_t seed() const { return seed_; }
  /// Why the last event could not be written; empty if it was.
  QString trouble() const { return trouble_; }

  /// Brings an event to the disk and gives the number of its line, 0 without a session. If it cannot be written, that
  /// is said and nothing is given: then what it announces must not be presented.
  std::optional<std::uint64_t> log(const wale::SessionEvent& event);
  /// Logs the programs that are not what was logged of these patches before: one line for each material, with all
  /// patches that are made of it, so that a workspace of thousands waits for the disk some times and not thousands of
  /// times. False if one cannot be written.
  bool log_programs(const std::vector<PatchToLog>& patches);
  /// Says where things lie now: the `what` ("patches", "keys") of `of`. What lies otherwise than the log says is logged
  /// before the next event, and a quarter of a second from now at most, so that a drag is some lines and not a hundred.
  /// `places` is called then and not later, and must give what is so now.
  void lay_out(const std::string& what, const std::string& of, std::function<std::vector<wale::SessionPlace>()> places);
  /// A seed for what is random next: of the session's own sequence, or any without a session.
  std::uint32_t next_seed();

 signals:
  void changed();
  void said(const QString& words);
  void failed();  ///< an event could not be written

 private:
  struct Logged {
    std::string material;
    std::uint64_t hash = 0;
  };

  using Layout = std::pair<std::string, std::string>;  // what, of

  std::optional<std::uint64_t> append(const wale::SessionEvent& event);
  bool log_places();
  bool log_places_of(const Layout& layout, const std::vector<wale::SessionPlace>& places);

  std::optional<wale::SessionLog> log_;
  QString participant_, trouble_;
  std::uint32_t seed_ = 0;
  std::mt19937 random_;
  std::map<std::string, Logged> programs_;  // by patches
  std::map<Layout, std::map<std::string, wale::SessionPlace>> places_;  // as they are in the log
  std::map<Layout, std::function<std::vector<wale::SessionPlace>()>> changed_places_;
  QTimer placing_;
};

}  // namespace sandpaper
