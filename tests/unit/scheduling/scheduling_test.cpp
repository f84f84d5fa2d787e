// Scheduling changes a whole process, so each test asks for it in a child, and compares with what the kernel shows in
// /proc. Where it is not allowed, the refusal is tested instead.
#include "scheduling/scheduling.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sched.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <functional>
#include <sstream>

namespace constrictor {
namespace {

/// What `ask` returns, called in a child.
std::string in_child(const std::function<std::string()>& ask) {
  int ends[2];
  EXPECT_EQ(::pipe(ends), 0);
  const pid_t child = ::fork();
  if (child == 0) {
    ::alarm(10);
    const std::string text = ask();
    static_cast<void>(!::write(ends[1], text.data(), text.size()));
    ::_exit(0);
  }
  ::close(ends[1]);
  std::string text;
  char part[512];
  for (ssize_t n = 0; (n = ::read(ends[0], part, sizeof part)) > 0;) text.append(part, static_cast<std::size_t>(n));
  ::close(ends[0]);
  int status = 0;
  ::waitpid(child, &status, 0);
  EXPECT_EQ(status, 0);
  return text;
}

/// The value of a line of /proc/self/status.
std::string from_status(const std::string& key) {
  std::ifstream file("/proc/self/status");
  for (std::string line; std::getline(file, line);) {
    if (!line.starts_with(key + ":")) continue;
    const auto value = line.find_first_not_of(" \t", key.size() + 1);
    return line.substr(value);
  }
  return {};
}

/// The number of the kernel's field of /proc/self/stat, counted from 1 as in proc(5).
std::string from_stat(int field) {
  std::ifstream file("/proc/self/stat");
  std::string text{std::istreambuf_iterator<char>(file), {}};
  std::istringstream words(text.substr(text.rfind(')') + 2));  // the name may contain spaces; the third field follows
  std::string word;
  for (int i = 3; i <= field; ++i) words >> word;
  return word;
}

TEST(Scheduling, ReadsListsOfProcessors) {
  EXPECT_EQ(parse_cpus("0"), std::vector<int>{0});
  EXPECT_EQ(parse_cpus("3,0-2,1"), (std::vector<int>{0, 1, 2, 3}));
  EXPECT_EQ(parse_cpus(cpus_text({0, 2, 5})), (std::vector<int>{0, 2, 5}));
  for (const char* wrong : {"", ",", "a", "-1", "1-", "2-1", "1,,2", "0x1", "1024", "1 2"}) {
    try {
      static_cast<void>(parse_cpus(wrong));
      ADD_FAILURE() << "accepted '" << wrong << "'";
    } catch (const std::invalid_argument& error) {
      EXPECT_NE(std::string(error.what()).find(fmt::format("found '{}', accepted", wrong)), std::string::npos);
    }
  }
}

TEST(Scheduling, NothingSpecialIsWantedByDefault) {
  const std::string found = in_child([] {
    const auto refusals = apply({});
    return fmt::format("{}|{}", refusals.size(), from_stat(41));
  });
  EXPECT_EQ(found, "0|0");  // SCHED_OTHER
}

TEST(Scheduling, TheRealTimeSchedulerIsInForceOrItsRefusalSaysWhatToDo) {
  const std::string found = in_child([] {
    const auto refusals = apply({7, false, {}});
    if (!refusals.empty()) return refusals.front();
    return fmt::format("policy {} priority {}; {}", from_stat(41), from_stat(40), scheduling_in_force());
  });
  if (found.starts_with("policy")) EXPECT_EQ(found.substr(0, found.find(',')), "policy 1 priority 7; FIFO 7");
  else EXPECT_NE(found.find("setcap cap_sys_nice"), std::string::npos) << found;
}

TEST(Scheduling, WithoutTheRightToItTheRefusalSaysWhatToDo) {
  const std::string found = in_child([] {
    ::prctl(PR_CAPBSET_DROP, 23, 0, 0, 0);  // CAP_SYS_NICE
    const rlimit none{0, 0};
    ::setrlimit(RLIMIT_RTPRIO, &none);
    ::setrlimit(RLIMIT_MEMLOCK, &none);
    if (::geteuid() == 0 && ::setresuid(65534, 65534, 65534) != 0) return std::string("cannot be tried");
    return fmt::format("{}", fmt::join(apply({7, true, {}}), "\n"));
  });
  EXPECT_NE(found.find("memory may not be locked (the limit is 0 KiB); a memlock limit"), std::string::npos) << found;
  EXPECT_NE(found.find("the real-time scheduler is not allowed (Operation not permitted); `setcap"), std::string::npos)
      << found;
}

TEST(Scheduling, LockedMemoryIsLockedAndCostsOnlyWhatIsUsed) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "the sanitizers replace mlockall by a function that does nothing";
#endif
  const std::string found = in_child([] {
    const auto refusals = apply({0, true, {}});
    if (!refusals.empty()) return refusals.front();
    const std::string before = from_status("VmRSS");
    const std::vector<char> unused = [] {
      std::vector<char> large;
      large.reserve(64'000'000);
      return large;
    }();
    return fmt::format("locked {}|{}|{}|{}", from_status("VmLck"), std::stol(before), std::stol(from_status("VmRSS")),
                       scheduling_in_force());
  });
  if (!found.starts_with("locked")) {
    EXPECT_NE(found.find("memlock"), std::string::npos) << found;
    return;
  }
  long locked_kib = 0, before_kib = 0, after_kib = 0;
  ASSERT_EQ(std::sscanf(found.c_str(), "locked %ld kB|%ld|%ld|", &locked_kib, &before_kib, &after_kib), 3) << found;
  EXPECT_GT(locked_kib, 1000);
  EXPECT_LT(after_kib - before_kib, 8000) << "memory that was reserved and not used must not be resident";
  EXPECT_NE(found.find("memory locked"), std::string::npos);
}

TEST(Scheduling, OnlyTheNamedProcessorsAreUsed) {
  const std::string all = from_status("Cpus_allowed_list");
  const int first = parse_cpus(all).front();
  const std::string found = in_child([&] {
    const auto refusals = apply({0, false, {first}});
    return fmt::format("{}|{}", refusals.size(), from_status("Cpus_allowed_list"));
  });
  EXPECT_EQ(found, fmt::format("0|{}", first));
}

TEST(Scheduling, AProcessorThatDoesNotExistIsRefusedByItsNumber) {
  const std::string found = in_child([] { return fmt::format("{}", fmt::join(apply({0, false, {1023}}), "")); });
  EXPECT_EQ(found.find("the processors 1023 cannot be used (Invalid argument); this computer has"), 0u) << found;
}

}  // namespace
}  // namespace constrictor
