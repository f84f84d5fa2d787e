// One call of a function of a session.
#pragma once

#include "python/session.hpp"

namespace constrictor::python {

/// One call of a public function: has the lock, and keeps close() waiting.
class Session::Turn {
 public:
  explicit Turn(Session& session, bool also_closed = false) : session_(session) {
    ++session_.users_;
    session_.turns_.lock();
    if (also_closed || !session_.closing_) return;
    leave();
    throw CommandError("the run was left: close() was called, or its `with` block has ended");
  }
  ~Turn() { leave(); }
  Turn(const Turn&) = delete;
  Turn& operator=(const Turn&) = delete;

 private:
  void leave() {
    session_.turns_.unlock();
    --session_.users_;
  }
  Session& session_;
};

}  // namespace constrictor::python
