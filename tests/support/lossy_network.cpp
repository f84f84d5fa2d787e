// lossy_network TAP=PID...: an Ethernet switch between network namespaces that delays, loses and reorders frames.
//
// Makes a TAP device with each name, moves it into the network namespace of the process with that PID, and passes
// frames between the devices. This kernel has no netem. It is controlled by lines on standard input, each answered by
// "ok" on standard output; it ends when standard input is closed:
//   loss P            each frame is lost with this probability, in each direction
//   delay MS JITTER   one way, uniformly distributed from MS to MS + JITTER; the order of frames is kept
//   reorder P         a frame overtakes those before it with this probability: it is not delayed
//   blackout S        no frame passes for S seconds
//   count             answers "ok PASSED LOST" instead
#include <fcntl.h>
#include <linux/if.h>
#include <linux/if_tun.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <deque>
#include <iostream>
#include <random>
#include <sstream>
#include <string>
#include <vector>

namespace {

using Clock = std::chrono::steady_clock;
using Milliseconds = std::chrono::duration<double, std::milli>;

struct Frame {
  Clock::time_point due;
  std::vector<char> bytes;
};

struct Port {
  int device = -1;
  std::deque<Frame> ordered;  ///< to be sent to this device, by time
  std::deque<Frame> overtaking;
  Clock::time_point last_due{};
};

class Network {
 public:
  void add(const std::string& name, const std::string& pid) {
    const int device = ::open("/dev/net/tun", O_RDWR | O_NONBLOCK | O_CLOEXEC);
    ifreq request{};
    request.ifr_flags = IFF_TAP | IFF_NO_PI;
    name.copy(request.ifr_name, IFNAMSIZ - 1);
    if (device < 0 || ::ioctl(device, TUNSETIFF, &request) != 0) throw std::runtime_error("cannot make TAP " + name);
    if (std::system(("ip link set " + name + " netns " + pid).c_str()) != 0)
      throw std::runtime_error("cannot move " + name + " into the namespace of " + pid);
    ports_.push_back({device, {}, {}, {}});
  }

  /// False: the controller is gone.
  bool run_once() {
    std::vector<pollfd> waits{{STDIN_FILENO, POLLIN, 0}};
    for (const auto& port : ports_) waits.push_back({port.device, POLLIN, 0});
    const timespec wait = time_to_next();
    ::ppoll(waits.data(), waits.size(), &wait, nullptr);
    if (waits[0].revents != 0 && !obey()) return false;
    for (auto& from : ports_) receive(from);
    for (auto& port : ports_) {
      deliver(port, port.ordered);
      deliver(port, port.overtaking);
    }
    return true;
  }

 private:
  bool obey() {
    char bytes[256];
    const ssize_t count = ::read(STDIN_FILENO, bytes, sizeof(bytes));
    if (count <= 0) return false;
    commands_.append(bytes, static_cast<std::size_t>(count));
    for (auto end = commands_.find('\n'); end != std::string::npos; end = commands_.find('\n')) {
      std::istringstream words(commands_.substr(0, end));
      commands_.erase(0, end + 1);
      std::string command;
      double first = 0, second = 0;
      words >> command >> first >> second;
      if (command == "loss") loss_ = first;
      if (command == "delay") delay_ = Milliseconds(first), jitter_ = Milliseconds(second);
      if (command == "reorder") reorder_ = first;
      if (command == "blackout")
        dark_until_ = Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(first));
      if (command == "count") std::printf("ok %lu %lu\n", passed_, lost_);
      else std::printf("ok\n");
      std::fflush(stdout);
    }
    return true;
  }

  void receive(Port& from) {
    char bytes[70000];
    for (ssize_t count = 0; (count = ::read(from.device, bytes, sizeof(bytes))) > 0;) {
      const auto now = Clock::now();
      for (auto& to : ports_) {
        if (&to == &from) continue;
        if (now < dark_until_ || uniform_(random_) < loss_) {
          ++lost_;
          continue;
        }
        ++passed_;
        std::vector<char> copy(bytes, bytes + count);
        if (uniform_(random_) < reorder_) {
          to.overtaking.push_back({now, std::move(copy)});
          continue;
        }
        const auto delay = std::chrono::duration_cast<Clock::duration>(delay_ + uniform_(random_) * jitter_);
        to.last_due = std::max(to.last_due, now + delay);
        to.ordered.push_back({to.last_due, std::move(copy)});
      }
    }
  }

  static void deliver(const Port& port, std::deque<Frame>& frames) {
    const auto now = Clock::now();
    while (!frames.empty() && frames.front().due <= now) {
      static_cast<void>(!::write(port.device, frames.front().bytes.data(), frames.front().bytes.size()));
      frames.pop_front();
    }
  }

  [[nodiscard]] timespec time_to_next() const {
    auto wait = std::chrono::nanoseconds(std::chrono::milliseconds(100));
    const auto now = Clock::now();
    for (const auto& port : ports_) {
      if (!port.ordered.empty())
        wait = std::min(wait, std::max<std::chrono::nanoseconds>(port.ordered.front().due - now, {}));
    }
    return {0, static_cast<long>(wait.count())};
  }

  std::vector<Port> ports_;
  std::string commands_;
  double loss_ = 0, reorder_ = 0;
  Milliseconds delay_{0}, jitter_{0};
  Clock::time_point dark_until_{};
  unsigned long passed_ = 0, lost_ = 0;
  std::mt19937 random_{1};
  std::uniform_real_distribution<double> uniform_{0, 1};
};

}  // namespace

int main(int argc, char** argv) {
  try {
    Network network;
    for (int i = 1; i < argc; ++i) {
      const std::string text = argv[i];
      const auto equals = text.find('=');
      if (equals == std::string::npos) throw std::runtime_error("found " + text + ", accepted TAP=PID");
      network.add(text.substr(0, equals), text.substr(equals + 1));
    }
    std::printf("ok\n");
    std::fflush(stdout);
    while (network.run_once()) {}
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "lossy_network: %s\n", error.what());
    return 70;
  }
}
