#include "tests/server/http/service_fixture.h"

#include "server/store/sqlite_store.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>

namespace toile {

using namespace std::chrono_literals;

namespace {

/// A socket with a timeout is interrupted where a child ends, though nothing handles SIGCHLD: posix_spawn in another
/// thread blocks it for a moment, and what is blocked counts as not ignored.
template <typename Call>
ssize_t uninterrupted(const Call& call) {
  ssize_t result;
  do result = call();
  while (result < 0 && errno == EINTR);
  return result;
}

}  // namespace

std::string Answer::header(const std::string& name) const {
  const std::size_t start = head.find("\r\n" + name + ": ");
  if (start == std::string::npos) return {};
  const std::size_t value = start + name.size() + 4;
  return head.substr(value, head.find("\r\n", value) - value);
}

void ServiceFixture::SetUp() {
  store_ = open_sqlite_store(folder_.path());
  options_.runner = TOILE_SOURCE "/tests/server/queue/fake_run.sh";
  options_.runs = folder_ / "runs";
  options_.heartbeat = 20ms;
  options_.retry_delay = 1ms;
  options_.grace = 100ms;
  dispatcher_ = std::make_unique<Dispatcher>(*store_, system_time_ms, options_);
  PreviewOptions preview_options;
  preview_options.runner = options_.runner;
  preview_options.folder = folder_ / "previews";
  previews_ = std::make_unique<PreviewRenderer>(*store_, preview_options);
  service_ = std::make_unique<Service>(Service{*store_, *dispatcher_, *previews_, system_time_ms, {}});
  HttpServerOptions server_options;
  server_options.keep_alive_s = 1;
  server_options.read_timeout_s = 1;
  server_ = std::make_unique<HttpServer>(make_router(*service_), server_options);
  port_ = server_->bind("127.0.0.1", 0);
  thread_ = std::thread([this] { server_->serve(); });
}

void ServiceFixture::TearDown() {
  if (server_) server_->stop();
  if (thread_.joinable()) thread_.join();
}

Answer ServiceFixture::raw(const std::string& bytes) const {
  const int connection = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port_));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  const timeval patience{5, 0};
  setsockopt(connection, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
  setsockopt(connection, SOL_SOCKET, SO_SNDTIMEO, &patience, sizeof patience);
  std::string text;
  if (connect(connection, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0) {
    std::size_t sent = 0;
    while (sent < bytes.size()) {
      const ssize_t count =
          uninterrupted([&] { return send(connection, bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL); });
      if (count <= 0) break;
      sent += static_cast<std::size_t>(count);
    }
    std::array<char, 65536> buffer;
    const auto receive = [&] { return recv(connection, buffer.data(), buffer.size(), 0); };
    for (ssize_t count; (count = uninterrupted(receive)) > 0;) {
      text.append(buffer.data(), static_cast<std::size_t>(count));
    }
  }
  close(connection);
  Answer answer;
  const std::size_t end = text.find("\r\n\r\n");
  if (end == std::string::npos || text.size() < 12) return answer;
  answer.status = std::atoi(text.c_str() + 9);
  answer.head = text.substr(0, end + 2);
  answer.body = text.substr(end + 4);
  return answer;
}

Answer ServiceFixture::request(const std::string& method, const std::string& path, const std::string& body,
                               const std::vector<std::pair<std::string, std::string>>& headers) const {
  std::string text = method + " " + path + " HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n";
  for (const auto& [name, value] : headers) text += name + ": " + value + "\r\n";
  if (!body.empty() || method == "POST") text += "Content-Length: " + std::to_string(body.size()) + "\r\n";
  return raw(text + "\r\n" + body);
}

std::string scene_named(const std::string& name) {
  return R"({"garments":[{"name":")" + name + R"(","rectangle":{"width_mm":300,"height_mm":300}}]})";
}

Answer ServiceFixture::submit(const std::string& what) const {
  return request("POST", "/v1/jobs", R"({"scene":)" + scene_named(what) + "}", {{"Content-Type", "application/json"}});
}

nlohmann::json ServiceFixture::wait_for_end(const std::string& id) const {
  const auto deadline = std::chrono::steady_clock::now() + 10s;
  for (;;) {
    nlohmann::json job = request("GET", "/v1/jobs/" + id).json();
    const std::string state = job.value("state", "");
    if ((state != "queued" && state != "running") || std::chrono::steady_clock::now() > deadline) return job;
    std::this_thread::sleep_for(5ms);
  }
}

}  // namespace toile
