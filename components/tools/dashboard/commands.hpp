// Carries out what viewers command, in threads of its own, because commands wait for their answers.
#pragma once

#include <atomic>
#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "client/request_client.hpp"
#include "client/run_control_client.hpp"
#include "dashboard/web_server.hpp"

namespace constrictor::dashboard {

/// The services that the page and other viewers can call: `pause`, `resume`, `step` {"ticks": N}, `pace` {"pace": X}
/// (0: as fast as possible), `stop` (emergency stop), `clear_stop`, `release`. The run obeys or refuses them as it does
/// the commands of `constrictor`.
class Commands {
 public:
  [[nodiscard]] static std::vector<std::string> services();

  explicit Commands(std::uint32_t domain);
  ~Commands();
  Commands(const Commands&) = delete;
  Commands& operator=(const Commands&) = delete;

  /// DDS participant in the run's domain, for readers of this process.
  [[nodiscard]] std::int32_t participant() const { return requests_.participant(); }
  void add(WebServer::Call call);
  /// Delivers the answers that have arrived. To be called in the thread of the server.
  void poll();

 private:
  /// One thread with its queue. An emergency stop must not wait for the answer to a pause, so there are two.
  class Lane {
   public:
    using Do = std::function<std::string(const WebServer::Call&)>;
    Lane(Commands& owner, Do what);
    ~Lane();
    void add(WebServer::Call call);

   private:
    void work();
    Commands& owner_;
    Do do_;
    std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<WebServer::Call> waiting_;
    bool ending_ = false;
    std::thread thread_;
  };
  std::string control(const WebServer::Call& call);
  std::string request(const WebServer::Call& call);
  void answered(std::function<void()> deliver);

  std::atomic<bool> ending_ = false;
  RequestClient requests_;
  RunControlClient run_;
  std::mutex mutex_;
  std::vector<std::function<void()>> answers_;
  Lane control_lane_, request_lane_;
};

}  // namespace constrictor::dashboard
