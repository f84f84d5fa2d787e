#include "cyclone/domain_claim.hpp"

#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <sys/file.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <chrono>
#include <cstddef>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace constrictor {

namespace {

std::filesystem::path lock_file(std::uint32_t domain) {
  return run_directory() / ("domain-" + std::to_string(domain) + ".lock");
}

/// Takes the domain's file lock. Returns the descriptor, or a negative number if another process holds the lock.
/// Children do not inherit it, because a child must not keep the claim of a launcher that died. The file is never
/// removed, because two processes could then lock two different files of the same name. `operation`: LOCK_EX for a
/// claim, LOCK_SH to see whether there is one.
int try_lock(std::uint32_t domain, int operation) {
  const auto file = lock_file(domain);
  const int lock = ::open(file.c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0600);
  if (lock < 0 || ::flock(lock, operation | LOCK_NB) == 0) return lock;
  ::close(lock);
  return -1;
}

/// Takes an abstract socket name, which belongs to the network namespace as the domain's ports do; negative if another
/// process has it. Runs with different run directories (other users, tests) do not see each other's locks, but they use
/// the same ports.
int try_name(std::uint32_t domain) {
  const int socket = ::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (socket < 0) return -1;
  const std::string name = "constrictor/domain/" + std::to_string(domain);
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  name.copy(address.sun_path + 1,
            sizeof address.sun_path -
                1);  // the leading zero makes the name abstract: without a file, and freed with the socket
  const auto size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + name.size());
  if (::bind(socket, reinterpret_cast<const sockaddr*>(&address), size) == 0) return socket;
  ::close(socket);
  return -1;
}

/// True if a port of UDP is in use.
bool port_in_use(std::uint32_t port) {
  const int socket = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (socket < 0) return false;
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_ANY);
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  const bool taken = ::bind(socket, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) != 0;
  ::close(socket);
  return taken;
}

/// True if the discovery port of one of the domain's first participants is in use: by another user's run, by a program
/// that claims no domain, or by a dashboard that shows the end of a run. Source: RTPS 2.3, 9.6.1.1.
bool domain_in_use(std::uint32_t domain) {
  constexpr std::uint32_t kParticipants = 16;
  for (std::uint32_t participant = 0; participant < kParticipants; ++participant)
    if (port_in_use(7400 + 250 * domain + 10 + 2 * participant)) return true;
  return false;
}

/// The file of a published DDS configuration.
std::filesystem::path configuration_file(std::uint32_t domain) {
  return run_directory() / ("domain-" + std::to_string(domain) + ".dds");
}

/// Removes what a killed owner of the domain has left: every file KIND-DOMAIN.ENDING but the lock. Its note and token
/// would be taken for those of the new owner.
void remove_left_files(std::uint32_t domain) {
  std::vector<std::filesystem::path> left;
  for (const auto& entry : std::filesystem::directory_iterator(run_directory())) {
    const auto& file = entry.path();
    if (file.stem().string().ends_with("-" + std::to_string(domain)) && file != lock_file(domain)) left.push_back(file);
  }
  std::error_code ignored;
  for (const auto& file : left) std::filesystem::remove(file, ignored);
}

/// Takes the lock for a claim. Another process may hold it for a moment, to see whether there is a claim.
int claim_lock(std::uint32_t domain) {
  constexpr int kTries = 25;
  int lock = -1;
  for (int i = 0; i < kTries && (lock = try_lock(domain, LOCK_EX)) < 0; ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  return lock;
}

constexpr std::uint32_t kFirst = 1, kLast = 100;  // domains among which a free one is chosen

}  // namespace

std::filesystem::path run_directory() {
  const char* runtime = std::getenv("XDG_RUNTIME_DIR");
  std::filesystem::path directory = runtime && *runtime
                                        ? std::filesystem::path(runtime) / "constrictor"
                                        : std::filesystem::path("/tmp/constrictor-" + std::to_string(::getuid()));
  if (std::filesystem::create_directories(directory))
    std::filesystem::permissions(directory, std::filesystem::perms::owner_all);  // the notes contain tokens
  return directory;
}

bool domain_claimed(std::uint32_t domain) {
  if (!std::filesystem::exists(lock_file(domain))) return false;
  const int lock = try_lock(domain, LOCK_SH);
  if (lock >= 0) ::close(lock);
  return lock < 0;
}

PublishedDdsConfiguration::PublishedDdsConfiguration(std::uint32_t domain, const std::string& xml)
    : file_(configuration_file(domain)) {
  const std::filesystem::path unfinished = file_.string() + ".new";
  std::ofstream file(unfinished);
  if (!(file << xml).flush()) throw std::runtime_error("cannot write " + unfinished.string());
  std::filesystem::rename(unfinished, file_);
}

PublishedDdsConfiguration::~PublishedDdsConfiguration() {
  std::error_code ignored;
  if (!file_.empty()) std::filesystem::remove(file_, ignored);
}

std::string published_dds_configuration(std::uint32_t domain) {
  std::ifstream file(configuration_file(domain));
  if (!file || !domain_claimed(domain)) return {};  // without a claim, its owner was killed and could not remove it
  return {std::istreambuf_iterator<char>(file), {}};
}

std::vector<std::uint32_t> used_domains() {
  std::vector<std::uint32_t> used;
  for (std::uint32_t domain = kFirst; domain <= kLast; ++domain) {
    if (domain_in_use(domain) || domain_claimed(domain)) used.push_back(domain);
  }
  return used;
}

DomainClaim::DomainClaim(std::optional<std::uint32_t> wanted, const std::set<std::uint32_t>& avoid) {
  for (std::uint32_t domain = wanted.value_or(kFirst); domain <= wanted.value_or(kLast); ++domain) {
    if (!wanted && (avoid.contains(domain) || domain_in_use(domain))) continue;
    name_ = try_name(domain);
    lock_ = name_ < 0 ? -1 : claim_lock(domain);
    domain_ = domain;
    if (lock_ >= 0) {
      remove_left_files(domain);
      return;
    }
    if (name_ >= 0) ::close(name_);
  }
  throw std::runtime_error(
      (wanted ? "DDS domain " + std::to_string(*wanted) + " is" : "no free DDS domain: 1 to 100 are") +
      " claimed on this host, in " + run_directory().string() + " or another directory of notes");
}

DomainClaim::~DomainClaim() {
  if (lock_ < 0) return;
  ::close(name_);
  ::close(lock_);  // last, because a waiting process takes the domain as soon as the lock is free
}

}  // namespace constrictor
