// Serves pictures over HTTP: /stream (multipart JPEG, as IP cameras do) and /snapshot.jpg.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>

#include "sim/camera_emulator/emulated_camera.hpp"

namespace constrictor::camera_emulator {

/// One thread calls all functions. A client that reads slowly loses frames; it delays no other client.
class StreamServer {
 public:
  /// `port` 0: any free one. Throws std::runtime_error if the port cannot be opened.
  StreamServer(const std::string& address, std::uint16_t port);
  ~StreamServer();
  StreamServer(const StreamServer&) = delete;
  StreamServer& operator=(const StreamServer&) = delete;

  [[nodiscard]] std::uint16_t port() const;
  /// Sends a frame to all clients of the stream.
  void send(const Jpeg& frame);
  /// Closes all connections and the port, or opens the same port again.
  void switch_on(bool on);
  /// Does what sockets are ready for, until `end`.
  void serve_until(std::chrono::steady_clock::time_point end);
  [[nodiscard]] std::size_t clients() const;

 private:
  struct Impl;
  class Session;
  std::shared_ptr<Impl> impl_;
};

}  // namespace constrictor::camera_emulator
