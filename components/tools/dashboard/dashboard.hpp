// A run as viewers see it: every topic as it is, and views of the whole scene.
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <memory>
#include <string>

#include "client/log_reader.hpp"
#include "client/parameters.hpp"
#include "cyclone/endpoint.hpp"
#include "cyclone/topic_tap.hpp"
#include "dashboard/controls.hpp"
#include "dashboard/web_server.hpp"
#include "views/newest.hpp"

namespace constrictor::dashboard {

/// An observer outside of the barrier: no member waits for it, and members read nothing from it except the commands of
/// its viewers. A replay looks like a run.
class Dashboard {
 public:
  /// `name` is shown to viewers.
  Dashboard(std::unique_ptr<Controls> controls, const std::string& name, WebOptions options);
  ~Dashboard();
  /// Waits for messages, at most 10 ms, and passes on what has arrived.
  void serve();
  /// Why the run or the replay is over; empty while it goes on.
  [[nodiscard]] std::string over() const { return controls_->over(); }
  /// Informs the viewers that the run or the replay is over, and gives them time to receive this message.
  void say_farewell();
  [[nodiscard]] const WebServer& server() const { return server_; }

 private:
  /// serve(), without looking for new topics.
  void pass_news();
  struct Readers;
  void pass_on(const dds::TopicTap::Topic& topic, const dds::RawSample& sample);
  void take_typed();
  void take_images();
  void take_parameters();
  void call(WebServer::Call call);
  void change(WebServer::Change wish);
  void show();

  std::unique_ptr<Controls> controls_;
  WebServer server_;
  dds::TopicTap tap_;
  std::unique_ptr<Readers> readers_;
  LogReader lines_;
  ParameterReader parameters_;
  std::map<const dds::TopicTap::Topic*, std::uint32_t> channels_;
  views::Newest newest_;
  bool changed_ = false;
  std::chrono::steady_clock::time_point shown_{};
  std::uint32_t scene_, transforms_, camera_, processed_, annotations_, lens_, log_, state_;  // channels of the views
};

}  // namespace constrictor::dashboard
