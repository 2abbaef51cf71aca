// SPDX-License-Identifier: Apache-2.0
#include <arpa/inet.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <csignal>
#include <thread>

#include <gmock/gmock.h>

#include "command_line.hpp"

namespace polhode::view_cli_tests {
namespace {

using testing::HasSubstr;
using testing::Not;

using ViewCommand = test::CommandLine;

TEST_F(ViewCommand, WritesOneSelfContainedPage) {
  ASSERT_EQ(run({"run", "model.yaml", "--quiet"}).code, 0);
  const test::ProgramResult r = run({"view", "model.results", "--html", "page.html"});
  EXPECT_EQ(r.code, 0);
  EXPECT_THAT(r.err, HasSubstr("51 frames"));
  const std::string page = read("page.html");
  EXPECT_THAT(page, HasSubstr("Content-Security-Policy"));
  EXPECT_THAT(page, HasSubstr("default-src 'none'"));
  EXPECT_THAT(page, HasSubstr("\"title\":\"Double pendulum\""));
  EXPECT_THAT(page, Not(HasSubstr("src=\"http")));
  EXPECT_THAT(page, Not(HasSubstr("unsafe-")));
}

TEST_F(ViewCommand, ShowsAModelBeforeItRuns) {
  EXPECT_EQ(run({"view", "model.yaml", "--html", "page.html", "--set", "title=Other"}).code, 0);
  const std::string page = read("page.html");
  EXPECT_THAT(page, HasSubstr("mobility 4, 8 constraint rows, 0 redundant"));
  EXPECT_THAT(page, HasSubstr("\"frames\":1,"));
  EXPECT_FALSE(exists("model.results"));
}

TEST_F(ViewCommand, WritesAPageAtTheEndOfARun) {
  EXPECT_EQ(run({"run", "model.yaml", "--quiet", "--view"}).code, 0);
  EXPECT_TRUE(exists("model.results/view.html"));
}

TEST_F(ViewCommand, ReportsErrors) {
  EXPECT_EQ(run({"view", "missing.h5", "--html", "x.html"}).code, 5);
  EXPECT_EQ(run({"view", "missing.yaml", "--html", "x.html"}).code, 5);
  write("wrong.yaml", "format: 1\nbodies: {a: {mas: 1}}\n");
  EXPECT_EQ(run({"view", "wrong.yaml", "--html", "x.html"}).code, 3);
  ASSERT_EQ(run({"run", "model.yaml", "--quiet"}).code, 0);
  EXPECT_EQ(run({"view", "model.results", "--set", "a=1", "--html", "x.html"}).code, 2);
}

/// Connection to a server on the loopback address that has sent a text.
int connection_to(int port, const std::string& request) {
  const int s = ::socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  for (int i = 0; i < 200; ++i) {
    if (::connect(s, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0) break;
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  (void)!::write(s, request.data(), request.size());
  return s;
}

/// Response of a server on the loopback address to a request.
std::string response_to(int port, const std::string& request) {
  const int s = connection_to(port, request);
  std::string text;
  std::array<char, 4096> part{};
  for (ssize_t n = 0; (n = ::read(s, part.data(), part.size())) > 0;)
    text.append(part.data(), static_cast<std::size_t>(n));
  ::close(s);
  return text;
}

std::string get(int port, const std::string& path, const std::string& host = "127.0.0.1") {
  return response_to(
      port, "GET " + path + " HTTP/1.1\r\nHost: " + host + ":" + std::to_string(port) + "\r\n\r\n");
}

TEST_F(ViewCommand, ServesThePageOnTheLoopbackAddressUntilItIsInterrupted) {
  const int port = 20000 + static_cast<int>(::getpid() % 20000);
  test::Program program =
      start({"view", "model.yaml", "--port", std::to_string(port), "--no-open"});
  EXPECT_THAT(get(port, "/"), HasSubstr("<!doctype html>"));
  EXPECT_THAT(get(port, "/scene.json"), HasSubstr("\"title\":\"Double pendulum\""));
  EXPECT_THAT(get(port, "/chunk/0"), HasSubstr("200 OK"));
  EXPECT_THAT(get(port, "/chunk/9999"), HasSubstr("404"));
  EXPECT_THAT(get(port, "/../model.yaml"), HasSubstr("404"));
  EXPECT_THAT(get(port, "/scene.json", "evil.example"), HasSubstr("403"));
  EXPECT_THAT(response_to(port, "POST / HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n"), HasSubstr("405"));
  write("model.yaml", "format: 1\nbodies: {a: {mas: 1}}\n");
  EXPECT_THAT(get(port, "/scene.json"), HasSubstr("model.yaml:2:14"));
  program.signal(SIGINT);
  const test::ProgramResult r = program.wait();
  EXPECT_EQ(r.code, 0);
  EXPECT_THAT(r.out, HasSubstr("http://127.0.0.1:" + std::to_string(port)));
}

// Clients that ask nothing, ask slowly, or do not read, and more of them than the server serves.
TEST_F(ViewCommand, ServesOthersWhileAClientIsSlow) {
  const int port = 20000 + static_cast<int>((::getpid() + 7) % 20000);
  test::Program program =
      start({"view", "model.yaml", "--port", std::to_string(port), "--no-open"});
  EXPECT_THAT(get(port, "/stamp"), HasSubstr("200 OK"));
  std::vector<int> slow;
  const std::string page = "GET / HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n";
  for (int i = 0; i < 40; ++i)
    for (const std::string& sent : {std::string(), page.substr(0, 10), page})
      slow.push_back(connection_to(port, sent));
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_THAT(get(port, "/scene.json"), HasSubstr("\"title\":\"Double pendulum\""));
  const std::chrono::duration<double> waited = std::chrono::steady_clock::now() - begin;
  EXPECT_LT(waited.count(), 4.0);  // below the five seconds for which a client may be silent
  for (const int s : slow) ::close(s);
  program.signal(SIGINT);
  EXPECT_EQ(program.wait().code, 0);
}

TEST_F(ViewCommand, ConvertsByFileExtension) {
  ASSERT_EQ(run({"run", "model.yaml", "--quiet"}).code, 0);
  for (const char* file : {"table.csv", "scene.glb", "grids.vtkhdf"}) {
    const test::ProgramResult r = run({"convert", "model.results", file});
    EXPECT_EQ(r.code, 0) << r.err;
    EXPECT_TRUE(exists(file)) << file;
  }
  EXPECT_EQ(read("grids.vtkhdf").substr(1, 3), "HDF");
  const test::ProgramResult r = run({"convert", "model.results", "out.xls"});
  EXPECT_EQ(r.code, 2);
  EXPECT_THAT(r.err, HasSubstr("cannot write '.xls' files. Name a .csv, .parquet, .vtkhdf, .glb"));
  const test::ProgramResult there =
      run({"convert", "model.results", "no/such/folder/grids.vtkhdf"});
  EXPECT_EQ(there.code, 5);
  EXPECT_THAT(there.err, HasSubstr("cannot be written"));
}

TEST_F(ViewCommand, PlotsChannelsForPapersAndListsThem) {
  ASSERT_EQ(run({"run", "model.yaml", "--quiet"}).code, 0);
  const test::ProgramResult list = run({"plot", "model.results"});
  EXPECT_EQ(list.code, 0);
  EXPECT_THAT(list.out, HasSubstr("bodies.upper.position"));
  EXPECT_EQ(run({"plot", "model.results", "energy", "joints.B.force", "-o", "fig.svg"}).code, 0);
  const std::string figure = read("fig.svg");
  EXPECT_THAT(figure, HasSubstr("<svg"));
  EXPECT_THAT(figure, HasSubstr("energy"));
  EXPECT_THAT(figure, HasSubstr("joints.B.force"));
  const test::ProgramResult wrong = run({"plot", "model.results", "enrgy", "-o", "other.svg"});
  EXPECT_EQ(wrong.code, 3);
  EXPECT_THAT(wrong.err, HasSubstr("there is no 'enrgy'"));
  EXPECT_FALSE(exists("other.svg"));
}

TEST_F(ViewCommand, ShowsOverlapsAtTheStart) {
  write("overlap.yaml",
        "format: 1\nbodies:\n  one: {shape: {sphere: 1}, density: 1}\n"
        "  two: {shape: {sphere: 1}, density: 1, position: [0.5, 0, 0]}\n"
        "contacts: {}\nanalysis: {duration: 1, step: 0.1}\n");
  EXPECT_EQ(run({"run", "overlap.yaml"}).code, 3);
  EXPECT_EQ(run({"view", "overlap.yaml", "--html", "page.html"}).code, 0);
  const std::string page = read("page.html");
  EXPECT_THAT(page, HasSubstr("shapes overlap at the start: 'one' in 'two' by 0.5 m"));
  EXPECT_THAT(page, HasSubstr("\"name\":\"two\",\"mark\":\"overlaps at the start\""));
}

}  // namespace
}  // namespace polhode::view_cli_tests
