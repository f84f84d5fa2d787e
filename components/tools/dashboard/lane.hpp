// A thread that executes the calls of viewers one after the other, because commands wait for their answers.
#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "dashboard/web_server.hpp"
#include "log/log.hpp"

namespace constrictor::dashboard {

/// Answers that wait until the thread of the server delivers them.
class Answers {
 public:
  void add(std::function<void()> deliver);
  /// To be called in the thread of the server.
  void deliver();

 private:
  std::mutex mutex_;
  std::vector<std::function<void()>> waiting_;
};

/// One thread with its queue. An emergency stop must not wait for the answer to a pause, so there are several.
class Lane {
 public:
  /// Carries out a call and returns its answer; throws std::exception with the reason of a refusal.
  using Do = std::function<std::string(const WebServer::Call&)>;
  /// Calls of the service `newest_only` take the place of a waiting call of the same kind, which is answered at once.
  /// `each_turn` is called between calls, at least every 50 ms; empty: never. `log` receives what it throws.
  Lane(Answers& answers, Do what, std::string newest_only = {}, std::function<void()> each_turn = {}, Log log = {});
  ~Lane();
  Lane(const Lane&) = delete;
  Lane& operator=(const Lane&) = delete;
  void add(WebServer::Call call);

 private:
  void work();
  void obey(const WebServer::Call& call);

  Answers& answers_;
  Do do_;
  std::string newest_only_;
  std::function<void()> each_turn_;
  Log log_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<WebServer::Call> waiting_;
  bool ending_ = false;
  std::thread thread_;
};

/// A number of the request from `low` to `high`. Throws std::invalid_argument with what is accepted.
double request_number(const WebServer::Call& call, const char* key, double low, double high);
/// A text of the request with at most 1000 bytes. Throws std::invalid_argument with what is accepted.
std::string request_text(const WebServer::Call& call, const char* key);

}  // namespace constrictor::dashboard
