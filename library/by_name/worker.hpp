#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <future>
#include <mutex>
#include <optional>

#include "compiler/command/deep_thread.hpp"
#include "schema/home_process.hpp"
#include "wale/library.hpp"

namespace wale {

/// A thread that does one piece of work after the other. It begins with the first piece; in a child of `fork` another
/// one begins with the child's first piece, and the work of the parent stays the parent's.
class Worker {
 public:
  using Work = std::function<Result<Compiled>()>;

  // The destructor waits for the piece that is under way, unless it is the parent's. Those that were not begun end with
  // `wrong_moment`.

  /// From any thread. What the work throws, its future throws. Error in the future: `short_of_resources` if the system
  /// gives no thread.
  std::future<Result<Compiled>> begin(Work work) { return (*queue_).begin(std::move(work)); }

 private:
  /// The work of one process, and the thread that does it.
  class Queue {
   public:
    ~Queue();
    std::future<Result<Compiled>> begin(Work work);

   private:
    struct Piece {
      Work work;
      std::promise<Result<Compiled>> result;
    };
    void serve();

    std::mutex mutex_;
    std::condition_variable news_;
    std::deque<Piece> waiting_;
    std::deque<Piece> dropped_;  // made early: a deque takes memory also when it is empty
    bool ends_ = false;
    std::optional<command::DeepThread> thread_;  // the last member: it uses the others
  };

  PerProcess<Queue> queue_;
};

}  // namespace wale
