// SPDX-License-Identifier: Apache-2.0
#include "loopback_server.hpp"

#include <array>
#include <csignal>

#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <polhode/core/format.hpp>
#include <polhode/io/text/file_error.hpp>

namespace polhode::cli {

namespace {

constexpr std::size_t kLongestRequest = 16384;
constexpr int kPatience = 5000;  ///< For a slow request [ms].

/// The head of a request; empty if it does not come to its end.
std::string read_head(int connection) {
  std::string head;
  std::array<char, 4096> part{};
  while (head.size() < kLongestRequest && head.find("\r\n\r\n") == std::string::npos) {
    pollfd waiting{connection, POLLIN, 0};
    if (::poll(&waiting, 1, kPatience) <= 0) return "";
    const ssize_t got = ::recv(connection, part.data(), part.size(), 0);
    if (got <= 0) return "";
    head.append(part.data(), static_cast<std::size_t>(got));
  }
  return head;
}

void send_all(int connection, const std::string& bytes) {
  std::size_t sent = 0;
  while (sent < bytes.size()) {
    const ssize_t n = ::send(connection, bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL);
    if (n <= 0) return;
    sent += static_cast<std::size_t>(n);
  }
}

/// Value of the line "Host:", without its port.
std::string host_of(const std::string& head) {
  for (const char* name : {"\r\nHost: ", "\r\nhost: "}) {
    const std::size_t at = head.find(name);
    if (at == std::string::npos) continue;
    const std::string line = head.substr(at + 8, head.find("\r\n", at + 8) - at - 8);
    return line.substr(0, line.rfind(':'));
  }
  return "";
}

WebAnswer answer_to(const std::string& head,
                    const std::function<WebAnswer(const std::string&)>& answer) {
  if (head.rfind("GET /", 0) != 0) return {405, "text/plain", "Only GET is answered.\n"};
  const std::string host = host_of(head);
  if (host != "127.0.0.1" && host != "localhost")
    return {403, "text/plain", "Only requests to the loopback address are answered.\n"};
  const std::string path = head.substr(4, head.find_first_of(" ?\r", 4) - 4);
  return answer(path);
}

}  // namespace

LoopbackServer::LoopbackServer(int port) {
  socket_ = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  const int yes = 1;
  ::setsockopt(socket_, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  socklen_t length = sizeof address;
  if (::bind(socket_, reinterpret_cast<sockaddr*>(&address), length) != 0 ||
      ::listen(socket_, 16) != 0 ||
      ::getsockname(socket_, reinterpret_cast<sockaddr*>(&address), &length) != 0) {
    ::close(socket_);
    throw FileError(format("127.0.0.1:{}", port), "cannot be served",
                    "Leave --port out, or name another one");
  }
  port_ = ntohs(address.sin_port);
}

LoopbackServer::~LoopbackServer() { ::close(socket_); }

void LoopbackServer::run(const std::function<WebAnswer(const std::string& path)>& answer,
                         const std::atomic<bool>& stop) const {
  while (!stop) {
    pollfd waiting{socket_, POLLIN, 0};
    if (::poll(&waiting, 1, 200) <= 0) continue;
    const int connection = ::accept(socket_, nullptr, nullptr);
    if (connection < 0) continue;
    const std::string head = read_head(connection);
    if (!head.empty()) {
      const WebAnswer a = answer_to(head, answer);
      send_all(connection,
               format("HTTP/1.0 {} {}\r\nContent-Type: {}\r\nContent-Length: {}\r\n"
                      "Cache-Control: no-store\r\nX-Content-Type-Options: nosniff\r\n"
                      "Connection: close\r\n\r\n",
                      a.status, a.status == 200 ? "OK" : "Refused", a.type, a.body.size()) +
                   a.body);
    }
    ::close(connection);
  }
}

}  // namespace polhode::cli
