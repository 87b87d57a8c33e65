#pragma once

#include <QObject>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>
#include <wale/language_service.hpp>

#include "feeling/hand_over.hpp"
#include "feeling/work_thread.hpp"

namespace sandpaper {

/// What a material compiles to: a program, or why there is none.
struct MaterialProgram {
  std::optional<wale::Program> program;
  std::vector<wale::Problem> problems;
};

using MaterialProgramRef = std::shared_ptr<const MaterialProgram>;

/// The programs of materials, compiled in the background and kept. In the window's thread.
class Programs : public QObject {
  Q_OBJECT

 public:
  explicit Programs(const wale::LanguageService& language, QObject* parent = nullptr);
  ~Programs() override;

  /// The device that programs are for. Those for other ones are forgotten.
  void set_device(const std::string& device);
  const std::string& device() const { return device_; }

  /// The program of a material as a patch is made of it, with the declarations around it. `file` is the path beside
  /// which imports and pictures are looked for. Null if it is not known yet: then it is compiled, and `compiled`
  /// follows. `urgency` as for `WorkThread`.
  MaterialProgramRef find(const std::string& surroundings, const std::string& file, const std::string& made_of,
                          int urgency = 0);
  bool is_busy() const { return thread_.waiting() > 0; }

 signals:
  void compiled(const QString& made_of);

 private:
  void keep(const std::string& key, const std::string& made_of, MaterialProgramRef program, std::uint64_t generation);

  const wale::LanguageService& language_;
  std::string device_;
  std::map<std::string, MaterialProgramRef> known_;  // null while it is being compiled
  std::uint64_t generation_ = 0;
  HandOver window_;
  WorkThread thread_;  // the last member: its work uses the others
};

}  // namespace sandpaper
