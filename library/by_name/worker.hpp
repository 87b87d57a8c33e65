#pragma once

#include <condition_variable>
#include <deque>
#include <exception>
#include <functional>
#include <future>
#include <memory>
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
  // The destructor waits for the piece that is under way, unless it is the parent's. Those that were not begun end with
  // `wrong_moment`.

  /// From any thread. What the work throws, its future throws. Error in the future: `short_of_resources` if the system
  /// gives no thread.
  template <class Value>
  std::future<Result<Value>> begin(std::function<Result<Value>()> work) {
    auto piece = std::make_unique<PieceOf<Value>>(std::move(work));
    auto result = piece->result.get_future();
    (*queue_).begin(std::move(piece));
    return result;
  }

 private:
  /// A piece of work, and the future that waits for it.
  struct Piece {
    virtual ~Piece() = default;
    virtual void run() = 0;
    virtual void end(Error error) = 0;
  };
  template <class Value>
  struct PieceOf final : Piece {
    explicit PieceOf(std::function<Result<Value>()> its) : work(std::move(its)) {}
    void run() override {
      try {
        result.set_value(work());
      } catch (...) {
        result.set_exception(std::current_exception());
      }
    }
    void end(Error error) override { result.set_value(std::move(error)); }

    std::function<Result<Value>()> work;
    std::promise<Result<Value>> result;
  };

  /// The work of one process, and the thread that does it.
  class Queue {
   public:
    ~Queue();
    void begin(std::unique_ptr<Piece> piece);

   private:
    void serve();

    std::mutex mutex_;
    std::condition_variable news_;
    std::deque<std::unique_ptr<Piece>> waiting_;
    std::deque<std::unique_ptr<Piece>> dropped_;  // made early: a deque takes memory also when it is empty
    bool ends_ = false;
    std::optional<command::DeepThread> thread_;  // the last member: it uses the others
  };

  PerProcess<Queue> queue_;
};

}  // namespace wale
