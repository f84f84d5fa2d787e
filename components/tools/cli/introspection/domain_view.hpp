// One DDS domain as an observer sees it: processes, readers and writers that discovery has found.
#pragma once

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "cyclone/discovery.hpp"
#include "cyclone/domain.hpp"

namespace constrictor::cli {

/// The options that all commands of this folder have.
struct ViewOptions {
  std::optional<std::uint32_t> domain;
  bool json = false;
};

/// The ENVIRONMENT of the commands that examine a DDS domain, for help_footer().
inline constexpr const char* kDomainEnvironment =
    "CONSTRICTOR_DOMAIN  the domain, like --run\n"
    "  CYCLONEDDS_URI      DDS configuration, needed to reach other hosts (deploy/cyclonedds)";

/// Adds --run and --json.
void add_view_options(CLI::App& app, ViewOptions& options);

class DomainView {
 public:
  /// Joins the domain that the options name, otherwise the domain of the only run on this host. Throws CommandError or
  /// dds::Error.
  explicit DomainView(const ViewOptions& options);
  /// Waits until discovery has found nothing new for 0.25 s, up to `bound`. Returns false if it found no reader and no
  /// writer.
  bool settle(std::chrono::milliseconds bound = std::chrono::milliseconds(1500)) const;
  /// The same, but throws CommandError if discovery found no reader and no writer.
  void settle_or_throw() const;
  /// Waits up to `bound` until `topic` has a writer.
  [[nodiscard]] std::optional<dds::Endpoint> find_writer(const std::string& topic,
                                                         std::chrono::milliseconds bound) const;

  [[nodiscard]] std::uint32_t domain() const { return number_; }
  [[nodiscard]] dds_entity_t participant() const { return domain_.participant(); }
  [[nodiscard]] const dds::Discovery& discovery() const { return discovery_; }
  /// The components of a participant, from the user data of its endpoints. If there is no user data: the name of its
  /// program. If the name is unknown: its GUID.
  [[nodiscard]] static std::string name_of(const dds::Guid& participant,
                                           const std::vector<dds::Participant>& participants,
                                           const std::vector<dds::Endpoint>& endpoints);

 private:
  std::uint32_t number_;
  dds::Domain domain_;
  dds::Discovery discovery_;
};

/// The topics that have a reader or writer in the domain, and those that this project defines. Sorted.
std::vector<std::string> topic_names(const DomainView& view);

/// The error message for a topic that does not exist. It names the existing topic with the closest name.
std::string no_such_topic(const DomainView& view, const std::string& topic);

/// True once SIGINT or SIGTERM arrived after the first call of this function.
bool interrupted();

}  // namespace constrictor::cli
