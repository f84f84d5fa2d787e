// pictures: the figure or the film of a recording. `constrictor figure` and `constrictor film` start it, and have
// checked the options.
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>

#include "common/interrupt.hpp"
#include "configuration/configuration.hpp"
#include "pictures/pictures.hpp"
#include "pictures/recorded_story.hpp"
#include "runtime/git_revision.hpp"
#include "runtime/host.hpp"
#include "runtime/numeric_profile.hpp"
#include "runtime/version_text.hpp"

namespace constrictor::pictures {

void check_interrupt() {
  if (interrupt_signal() != 0) throw Interrupted();
}

void require_writable(const std::filesystem::path& file) {
  const std::filesystem::path beside = file.string() + ".part";
  const bool writable = std::ofstream(beside).is_open();
  const int error = errno;
  std::error_code ignored;
  std::filesystem::remove(beside, ignored);
  if (!writable) throw std::runtime_error(fmt::format("cannot write {}: {}", file.string(), std::strerror(error)));
  if (std::filesystem::is_directory(file)) throw std::runtime_error(fmt::format("{} is a folder", file.string()));
}

namespace {

using nlohmann::json;

int draw(const json& wish) {
  ::signal(SIGXFSZ, SIG_IGN);  // a limit of the file's size is an error and not the end
  if (wish.at("picture") == "figure") {
    FigureOptions options;
    options.file = wish.at("file").get<std::string>();
    options.output = wish.at("output").get<std::string>();
    const std::string format = wish.at("format");
    options.format = figure::format_of("figure." + format).value();
    options.width = wish.at("width");
    options.at_s = wish.at("at").get<std::vector<double>>();
    options.events = wish.at("events").get<std::vector<std::uint8_t>>();
    return make_figure(options);
  }
  FilmOptions options;
  options.file = wish.at("file").get<std::string>();
  options.output = wish.at("output").get<std::string>();
  options.speed = wish.at("speed");
  if (wish.contains("from")) options.from_s = wish["from"].get<double>();
  if (wish.contains("to")) options.to_s = wish["to"].get<double>();
  options.rate_hz = wish.at("fps");
  options.width = wish.at("width");
  options.height = wish.at("height");
  options.jobs = wish.at("jobs");
  return make_film(options);
}

}  // namespace
}  // namespace constrictor::pictures

int main(int argc, char** argv) {
  using namespace constrictor;
  const std::string argument = argc == 2 ? argv[1] : "--help";
  if (argument == "--version") {
    fmt::print("{}\n", version_text("pictures", kGitRevision));
    return exit_status::kOk;
  }
  const auto wish = nlohmann::json::parse(argument, nullptr, false);
  if (!wish.is_object()) {
    fmt::print("pictures: `constrictor figure` and `constrictor film` start this program; see their --help\n");
    return argument == "--help" ? exit_status::kOk : exit_status::kUsage;
  }
  ensure_numeric_environment(argv);  // images that are computed again must be those of the run
  catch_interrupts();
  const std::string name = wish.value("picture", "");
  try {
    return pictures::draw(wish);
  } catch (const pictures::Interrupted&) {
    fmt::print(stderr, "{}: interrupted; nothing was written\n", name);
    return interrupt_status();
  } catch (const pictures::NoPicture& error) {
    fmt::print(stderr, "{}: {}\n", name, error.what());
    return exit_status::kConfiguration;
  } catch (const ConfigurationError& error) {
    fmt::print(stderr, "{}: {}\n", name, error.what());
    return exit_status::kConfiguration;
  } catch (const nlohmann::json::exception& error) {
    fmt::print(stderr, "pictures: wrong arguments: {}\n", error.what());
    return exit_status::kUsage;
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}: {}\n", name, error.what());
    return exit_status::kSoftware;
  }
}
