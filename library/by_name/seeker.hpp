#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <string>

#include "compiler/open_file.hpp"
#include "schema/home_process.hpp"
#include "wale/search.hpp"

namespace wale {

struct IndexHere;

/// Searches for programs, in the index at one place. Safe from any thread; searches that need an index wait for each other.
class Seeker {
 public:
  /// `place` is that of `open_index`.
  explicit Seeker(std::string place) : place_(std::move(place)) {}

  // `request` has the device and the folders. Errors are those of the calls of `Library`.
  Result<SearchResult> search(const std::string& text, const SearchOptions& options, const FileRequest& request);
  Result<SearchResult> nearest(const std::string& material, SearchOptions options, const FileRequest& request);
  Result<SearchResult> between(const std::string& one, const std::string& other, const SearchOptions& options,
                               const FileRequest& request);
  /// Ends what is under way, and whatever is begun later, with W0706 as soon as a library would be read.
  void end() { ends_ = true; }

 private:
  /// What this process has open.
  struct Opened {
    Opened();
    ~Opened();
    std::mutex mutex;
    std::unique_ptr<IndexHere> here;
    std::vector<Error> warnings;
  };
  Result<SearchResult> by_feel(const std::string& text, const SearchOptions& options, const FileRequest& request,
                               const char* near);
  Result<> open(Opened& opened, const SearchOptions& options, const FileRequest& request,
                const std::vector<std::string>& meant) const;

  std::string place_;
  std::atomic<bool> ends_ = false;
  PerProcess<Opened> opened_;
};

}  // namespace wale
