// SPDX-License-Identifier: Apache-2.0
#include "loopback_server.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <charconv>
#include <list>
#include <optional>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <polhode/core/format.hpp>
#include <polhode/io/text/file_error.hpp>

#include "console.hpp"

namespace polhode::cli {

namespace {

constexpr std::size_t kLongestRequest = 16384;
constexpr std::size_t kLargestBody = std::size_t{1} << 30;
/// Clients at a time; of more, the one that has been silent longest is dropped.
constexpr std::size_t kMostClients = 64;
/// Longest silence of a client [s].
constexpr double kPatience = 5.0;
/// Interval at which `stop` is looked at [ms].
constexpr int kLook = 200;

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

/// Bytes of the body that a header announces; nothing if it does not say so, or more than allowed.
std::optional<std::size_t> body_size(const std::string& head) {
  const std::string length = value_of(head, "content-length");
  std::size_t size = 0;
  const auto [stop, fault] = std::from_chars(length.data(), length.data() + length.size(), size);
  if (fault != std::errc() || size > kLargestBody) return std::nullopt;
  return size;
}

bool is_sent(const std::string& head) { return head.rfind("POST /", 0) == 0; }

/// @param body  What came after the header, complete.
WebAnswer answer_to(const std::string& head, std::string body, int port, bool takes,
                    const std::function<WebAnswer(const WebRequest&)>& answer) {
  const bool sent = takes && is_sent(head);
  if (head.rfind("GET /", 0) != 0 && !sent) return {405, "text/plain", "Only GET is answered.\n"};
  const std::string host = value_of(head, "host"), name = host.substr(0, host.rfind(':'));
  if (name != "127.0.0.1" && name != "localhost")
    return {403, "text/plain", "Only requests to the loopback address are answered.\n"};
  if (sent && value_of(head, "origin") != format("http://127.0.0.1:{}", port))
    return {403, "text/plain", "Only pages of this server may send.\n"};
  const std::size_t begin = head.find(' ') + 1;
  WebRequest request{head.substr(begin, head.find_first_of(" ?\r", begin) - begin), sent};
  if (sent) {
    if (!body_size(head)) return {400, "text/plain", "The request is incomplete.\n"};
    request.body = std::move(body);
  }
  return answer(request);
}

/// Text of an answer as it is sent.
std::string message(WebAnswer answer) {
  return format(
             "HTTP/1.0 {} {}\r\nContent-Type: {}\r\nContent-Length: {}\r\nCache-Control: "
             "no-store\r\nX-Content-Type-Options: nosniff\r\nConnection: close\r\n\r\n",
             answer.status, answer.status == 200 ? "OK" : "Refused", answer.type,
             answer.body.size()) +
         std::move(answer.body);
}

/// A client: its request as far as it has come, then what is still to be sent. Nothing here waits.
class Client {
 public:
  explicit Client(int connection) : connection_(connection), heard_(wall_clock()) {
    ::fcntl(connection_, F_SETFL, O_NONBLOCK);
    ::fcntl(connection_, F_SETFD, FD_CLOEXEC);
  }
  ~Client() { ::close(connection_); }
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;

  [[nodiscard]] pollfd wanted() const {
    return {connection_, static_cast<short>(reply_.empty() ? POLLIN : POLLOUT), 0};
  }
  [[nodiscard]] double heard() const { return heard_; }
  [[nodiscard]] bool over() const { return over_; }
  /// Does not count a time in which the server was busy as silence.
  void excuse(double seconds) { heard_ += seconds; }

  /// Takes what has come; a complete request is answered by `answer(head, body)`.
  template <class Answer>
  void receive(bool takes, const Answer& answer) {
    std::array<char, 65536> part{};
    const ssize_t got = ::recv(connection_, part.data(), part.size(), 0);
    if (got < 0 && (errno == EAGAIN || errno == EINTR)) return;
    if (got <= 0) {
      over_ = true;
      return;
    }
    heard_ = wall_clock();
    request_.append(part.data(), static_cast<std::size_t>(got));
    const std::size_t end = request_.find("\r\n\r\n");
    if (end == std::string::npos) {
      over_ = request_.size() >= kLongestRequest;
      return;
    }
    const std::size_t head = end + 4;
    const std::size_t body =
        takes && is_sent(request_) ? body_size(request_.substr(0, head)).value_or(0) : 0;
    if (request_.size() < head + body) return;
    reply_ = answer(request_.substr(0, head), request_.substr(head, body));
    request_.clear();
    send();
  }

  void send() {
    const ssize_t count =
        ::send(connection_, reply_.data() + sent_, reply_.size() - sent_, MSG_NOSIGNAL);
    if (count < 0 && (errno == EAGAIN || errno == EINTR)) return;
    if (count > 0) heard_ = wall_clock();
    sent_ += static_cast<std::size_t>(std::max<ssize_t>(count, 0));
    over_ = count <= 0 || sent_ == reply_.size();
  }

 private:
  int connection_;
  double heard_;  ///< Time of the last byte [s].
  std::string request_, reply_;
  std::size_t sent_ = 0;
  bool over_ = false;
};

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
  std::list<Client> clients;
  const auto reply = [&](const std::string& head, std::string body) {
    return message(answer_to(head, std::move(body), port_, takes, answer));
  };
  while (!stop) {
    std::vector<pollfd> waiting{{socket_, POLLIN, 0}};
    for (const Client& client : clients) waiting.push_back(client.wanted());
    if (::poll(waiting.data(), static_cast<nfds_t>(waiting.size()), kLook) < 0) continue;
    const double begin = wall_clock();
    auto ready = waiting.begin() + 1;
    for (Client& client : clients) {
      if (ready->revents != 0) {
        if (ready->events == POLLOUT)
          client.send();
        else
          client.receive(takes, reply);
      }
      ++ready;
    }
    const double now = wall_clock();
    for (Client& client : clients) client.excuse(now - begin);
    clients.remove_if([&](const Client& c) { return c.over() || now - c.heard() > kPatience; });
    if (waiting.front().revents == 0) continue;
    const int connection = ::accept(socket_, nullptr, nullptr);
    if (connection < 0) continue;
    if (clients.size() >= kMostClients)
      clients.erase(
          std::min_element(clients.begin(), clients.end(),
                           [](const Client& a, const Client& b) { return a.heard() < b.heard(); }));
    clients.emplace_back(connection);
  }
}

}  // namespace polhode::cli
