// SPDX-License-Identifier: Apache-2.0
#include "loopback_server.hpp"

#include <array>
#include <cctype>
#include <charconv>
#include <csignal>
#include <optional>

#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <polhode/core/format.hpp>
#include <polhode/io/text/file_error.hpp>

namespace polhode::cli {

namespace {

constexpr std::size_t kLongestRequest = 16384;
constexpr int kPatience = 5000;  ///< Timeout of a slow request [ms].

constexpr std::size_t kLargestBody = std::size_t{1} << 30;

/// Appends received text. @returns whether there was any.
bool receive(int connection, std::string& text) {
  std::array<char, 65536> part{};
  pollfd waiting{connection, POLLIN, 0};
  if (::poll(&waiting, 1, kPatience) <= 0) return false;
  const ssize_t got = ::recv(connection, part.data(), part.size(), 0);
  if (got > 0) text.append(part.data(), static_cast<std::size_t>(got));
  return got > 0;
}

/// Header of a request and the text received after it; empty if the header is incomplete.
std::string read_head(int connection) {
  std::string head;
  while (head.find("\r\n\r\n") == std::string::npos)
    if (head.size() >= kLongestRequest || !receive(connection, head)) return "";
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

/// Value of a header line; `name` is in lower case.
std::string value_of(const std::string& head, const std::string& name) {
  const std::size_t end = head.find("\r\n\r\n");
  for (std::size_t at = head.find("\r\n"); at < end; at = head.find("\r\n", at + 2)) {
    std::string line = head.substr(at + 2, head.find("\r\n", at + 2) - at - 2);
    const std::size_t colon = line.find(':');
    if (colon != name.size()) continue;
    for (std::size_t k = 0; k < colon; ++k)
      line[k] = static_cast<char>(std::tolower(static_cast<unsigned char>(line[k])));
    if (line.rfind(name, 0) == 0) return line.substr(std::min(line.size(), colon + 2));
  }
  return "";
}

/// Body of a request; nothing if the connection ends before it is complete.
std::optional<std::string> read_body(int connection, const std::string& head) {
  const std::string length = value_of(head, "content-length");
  std::size_t size = 0;
  const auto [stop, fault] = std::from_chars(length.data(), length.data() + length.size(), size);
  if (fault != std::errc() || size > kLargestBody) return std::nullopt;
  std::string body = head.substr(head.find("\r\n\r\n") + 4);
  while (body.size() < size)
    if (!receive(connection, body)) return std::nullopt;
  return body;
}

WebAnswer answer_to(int connection, const std::string& head, int port, bool takes,
                    const std::function<WebAnswer(const WebRequest&)>& answer) {
  const bool sent = takes && head.rfind("POST /", 0) == 0;
  if (head.rfind("GET /", 0) != 0 && !sent) return {405, "text/plain", "Only GET is answered.\n"};
  const std::string host = value_of(head, "host"), name = host.substr(0, host.rfind(':'));
  if (name != "127.0.0.1" && name != "localhost")
    return {403, "text/plain", "Only requests to the loopback address are answered.\n"};
  if (sent && value_of(head, "origin") != format("http://127.0.0.1:{}", port))
    return {403, "text/plain", "Only pages of this server may send.\n"};
  const std::size_t begin = head.find(' ') + 1;
  WebRequest request{head.substr(begin, head.find_first_of(" ?\r", begin) - begin), sent};
  if (sent) {
    std::optional<std::string> body = read_body(connection, head);
    if (!body) return {400, "text/plain", "The request is incomplete.\n"};
    request.body = std::move(*body);
  }
  return answer(request);
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
    throw io::FileError(format("127.0.0.1:{}", port), "cannot be served",
                        "Leave --port out, or name another one");
  }
  port_ = ntohs(address.sin_port);
}

LoopbackServer::~LoopbackServer() { ::close(socket_); }

void LoopbackServer::run(const std::function<WebAnswer(const WebRequest& request)>& answer,
                         const std::atomic<bool>& stop, bool takes) const {
  while (!stop) {
    pollfd waiting{socket_, POLLIN, 0};
    if (::poll(&waiting, 1, 200) <= 0) continue;
    const int connection = ::accept(socket_, nullptr, nullptr);
    if (connection < 0) continue;
    const std::string head = read_head(connection);
    if (!head.empty()) {
      const WebAnswer a = answer_to(connection, head, port_, takes, answer);
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
