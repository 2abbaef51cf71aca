// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <functional>
#include <string>

namespace polhode::cli {

/// An answer to a request for a path.
struct WebAnswer {
  int status = 200;
  std::string type = "text/plain; charset=utf-8";
  std::string body{};
};

/// A request of a page.
struct WebRequest {
  std::string path;
  bool sent = false;   ///< POST.
  std::string body{};  ///< Received data.
};

/// Minimal HTTP/1.0 server on 127.0.0.1: answers GET, one request after another. It waits for no
/// client: one that is slow to ask or to read does not delay the others. Requests with a Host other
/// than the loopback address are rejected, so that no web site can read results through a name that
/// resolves to it. POST is accepted if enabled, and only from pages of this server.
class LoopbackServer {
 public:
  /// @param port  0: any free one. @throws FileError if the port is not available.
  explicit LoopbackServer(int port);
  ~LoopbackServer();
  LoopbackServer(const LoopbackServer&) = delete;
  [[nodiscard]] int port() const { return port_; }
  /// Answers requests until `stop` is set. @param takes  Accept POST too.
  void run(const std::function<WebAnswer(const WebRequest& request)>& answer,
           const std::atomic<bool>& stop, bool takes = false) const;

 private:
  int socket_ = -1, port_ = 0;
};

}  // namespace polhode::cli
