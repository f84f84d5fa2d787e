// Heavy attacks from outside of a run, with and without DDS Security: huge samples, and a million packets that were
// overheard and changed. Needs root, because it listens to the loopback interface.
#include <arpa/inet.h>
#include <netinet/if_ether.h>
#include <netinet/ip.h>
#include <netinet/udp.h>
#include <sys/socket.h>

#include <random>
#include <vector>

#include "integration/attacked_run.hpp"
#include "integration/attacker.hpp"

namespace constrictor::testing {
namespace {

constexpr int kPackets = 1'000'000;

/// RTPS packets on the loopback interface to the unicast ports of a domain.
class Eavesdropper {
 public:
  explicit Eavesdropper(unsigned domain)
      : first_port_(static_cast<std::uint16_t>(7400 + 250 * domain)),
        socket_(::socket(AF_PACKET, SOCK_DGRAM, htons(ETH_P_IP))) {}
  ~Eavesdropper() { ::close(socket_); }
  Eavesdropper(const Eavesdropper&) = delete;
  Eavesdropper& operator=(const Eavesdropper&) = delete;
  [[nodiscard]] bool permitted() const { return socket_ >= 0; }
  struct Packet {
    std::uint16_t port;
    std::string bytes;
  };
  [[nodiscard]] std::vector<Packet> listen(std::size_t count) const {
    std::vector<Packet> packets;
    std::string buffer(65536, '\0');
    static_cast<void>(eventually(
        [&] {
          for (;;) {
            const ssize_t size = ::recv(socket_, buffer.data(), buffer.size(), MSG_DONTWAIT);
            if (size < 0 || packets.size() >= count) return packets.size() >= count;
            if (static_cast<std::size_t>(size) < sizeof(iphdr) + sizeof(udphdr) + 20 || buffer[9] != IPPROTO_UDP)
              continue;
            const std::size_t header = static_cast<std::size_t>(buffer[0] & 15) * 4;
            std::uint16_t port = 0;
            std::memcpy(&port, buffer.data() + header + 2, sizeof port);
            port = ntohs(port);
            const std::string bytes = buffer.substr(header + 8, static_cast<std::size_t>(size) - header - 8);
            if (port >= first_port_ && port < first_port_ + 250 && bytes.starts_with("RTPS"))
              packets.push_back({port, bytes});
          }
        },
        20s));
    return packets;
  }

 private:
  std::uint16_t first_port_;
  int socket_;
};

class HeavyAttacks : public AttackedRun {
 protected:
  void SetUp() override { environment_["XDG_RUNTIME_DIR"] = dir_.string(); }
  /// Sends changed copies of overheard packets to the ports where they were overheard.
  void send_changed(const std::vector<Eavesdropper::Packet>& overheard) const {
    const int socket = ::socket(AF_INET, SOCK_DGRAM, 0);
    ASSERT_GE(socket, 0);
    std::mt19937 random(20261122);
    for (int i = 0; i < kPackets; ++i) {
      auto [port, bytes] = overheard[random() % overheard.size()];
      const std::size_t from = random() % 4 == 0 ? 0 : 20;  // behind the header, mostly
      for (std::uint32_t changes = 1 + random() % 4; changes > 0; --changes)
        bytes[from + random() % (bytes.size() - from)] = static_cast<char>(random());
      if (random() % 8 == 0) bytes.resize(20 + random() % (bytes.size() - 19));
      sockaddr_in to{};
      to.sin_family = AF_INET;
      to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
      to.sin_port = htons(port);
      static_cast<void>(::sendto(socket, bytes.data(), bytes.size(), 0, reinterpret_cast<sockaddr*>(&to), sizeof to));
    }
    ::close(socket);
  }
  void attack_with_packets(const std::vector<std::string>& options, bool result_must_be_equal) {
    constexpr long kTicks = 6000;
    Process reference = run(kTicks, "reference", {"--in-process"});
    ASSERT_EQ(reference.wait(120s), exit_status::kOk) << reference.errors();
    std::vector<std::string> with = options;
    with.insert(with.end(), {"--pace", "1x"});
    Process launcher = run(kTicks, "r", with);
    ASSERT_TRUE(launcher.wait_for("simulated", 40s)) << launcher.output() << launcher.errors();
    const Eavesdropper ear(domain_of(launcher));
    ASSERT_TRUE(ear.permitted()) << "run this test as root";
    const auto overheard = ear.listen(2000);
    ASSERT_EQ(overheard.size(), 2000u);
    const long before_kib = memory_kib();
    const auto pids = members();
    const auto log_before = log_size("r");
    const auto began = std::chrono::steady_clock::now();
    send_changed(overheard);
    const double wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
    const long grown_kib = memory_kib() - before_kib;
    const auto logged = log_size("r") - log_before;
    std::printf("%d changed packets in %.0f s%s: memory of 5 processes %+ld KiB, logs %ju bytes\n", kPackets, wall_s,
                options.empty() ? "" : " (secured)", grown_kib, logged);
    EXPECT_LT(grown_kib, 200'000);
    EXPECT_LT(logged, 1'000'000u);
    if (result_must_be_equal) {
      EXPECT_EQ(members(), pids) << "a process died";
      ASSERT_EQ(launcher.wait(240s), exit_status::kOk) << launcher.output() << launcher.errors();
      EXPECT_EQ(report("r").value("state_hash", "none"), report("reference").value("state_hash", "nothing"));
      return;
    }
    // Without security a forged packet with the address of a member can stop a stream, and the run gives up in order.
    const auto status = launcher.wait(240s);
    ASSERT_TRUE(status.has_value());
    EXPECT_TRUE(*status == exit_status::kOk || *status == exit_status::kWaitedTooLong) << *status << launcher.output();
    std::printf("  the run ended with status %d\n", *status);
  }
};

TEST_F(HeavyAttacks, AMillionChangedPacketsCrashNothingAndFillNeitherMemoryNorDisk) { attack_with_packets({}, false); }

TEST_F(HeavyAttacks, AMillionChangedPacketsDoNotChangeASecuredRun) {
  Process keys = command({"keys", (dir_ / "keys").string(), "--manifest", (dir_ / "toys.yaml").string()});
  ASSERT_EQ(keys.wait(30s), exit_status::kOk) << keys.errors();
  attack_with_packets({"--secure", (dir_ / "keys").string()}, true);
}

TEST_F(HeavyAttacks, FourTickDonesOfTwoHundredMegabytesAreDropped) {
  constexpr long kTicks = 3000;
  Process reference = run(kTicks, "reference", {"--in-process"});
  ASSERT_EQ(reference.wait(120s), exit_status::kOk) << reference.errors();
  Process launcher = run(kTicks, "r", {"--pace", "2x"});
  Attacker attacker(domain_of(launcher));
  ASSERT_TRUE(attacker.ready_to_forge(5)) << launcher.output();
  const long before_kib = memory_kib();
  std::vector<std::uint8_t> block(200'000'000, 'x');
  long largest_kib = 0;
  for (int i = 0; i < 4; ++i) {
    msg::TickDone message{};
    dds::set_text(message.component, "navigation");
    message.run_id = attacker.state->run_id;
    message.epoch = attacker.state->epoch;
    message.incarnation = 1;
    message.index = attacker.state->tick + 1;
    message.checkpoint = {static_cast<std::uint32_t>(block.size()), static_cast<std::uint32_t>(block.size()),
                          block.data(), false};
    attacker.done.write(message);
    static_cast<void>(eventually(
        [&] {
          largest_kib = std::max(largest_kib, memory_kib() - before_kib);
          return false;
        },
        1s));
  }
  std::printf("4 TickDones of 200 MB: memory of 5 processes at most %+ld KiB\n", largest_kib);
  EXPECT_LT(largest_kib, 100'000);
  ASSERT_EQ(launcher.wait(120s), exit_status::kOk) << launcher.output() << launcher.errors();
  EXPECT_EQ(report("r").value("state_hash", "none"), report("reference").value("state_hash", "nothing"));
}

}  // namespace
}  // namespace constrictor::testing
