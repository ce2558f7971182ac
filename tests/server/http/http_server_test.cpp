#include "server/http/http_server.h"

#include <gtest/gtest.h>
#include <sys/socket.h>

#include <chrono>
#include <future>
#include <memory>
#include <thread>

namespace toile {
namespace {

using namespace std::chrono_literals;

/// serve() on a thread of its own; the future is ready once it has returned. A serve() that never returns keeps its
/// thread and its server, so that the test can fail instead of hanging.
std::future<void> serve(const std::shared_ptr<HttpServer>& server) {
  std::packaged_task<void()> task([server] { server->serve(); });
  std::future<void> served = task.get_future();
  std::thread(std::move(task)).detach();
  return served;
}

std::shared_ptr<HttpServer> bound_server() {
  HttpServerOptions options;
  options.threads = 1;
  auto server = std::make_shared<HttpServer>(Router{}, options);
  server->bind("127.0.0.1", 0);
  return server;
}

TEST(HttpServer, AStopBeforeServeIsKept) {
  const auto server = bound_server();
  server->stop();
  EXPECT_EQ(serve(server).wait_for(10s), std::future_status::ready);
}

TEST(HttpServer, AStopWhileServeBeginsIsKept) {
  for (int delay_us = 0; delay_us < 200; ++delay_us) {
    const auto server = bound_server();
    const std::future<void> served = serve(server);
    const auto start = std::chrono::steady_clock::now();
    while (std::chrono::steady_clock::now() - start < std::chrono::microseconds(delay_us)) continue;
    server->stop();
    ASSERT_EQ(served.wait_for(10s), std::future_status::ready) << "stopped after " << delay_us << " µs";
  }
}

/// This process's descriptor that listens; −1: none or several.
int listening_socket() {
  int found = -1, count = 0;
  for (int descriptor = 0; descriptor < 1024; ++descriptor) {
    int listens = 0;
    socklen_t size = sizeof listens;
    if (getsockopt(descriptor, SOL_SOCKET, SO_ACCEPTCONN, &listens, &size) != 0 || listens == 0) continue;
    found = descriptor;
    ++count;
  }
  return count == 1 ? found : -1;
}

TEST(HttpServer, AListenerThatBreaksIsAnError) {
  const auto server = bound_server();
  std::future<void> served = serve(server);
  const int listener = listening_socket();
  ASSERT_GE(listener, 0);
  EXPECT_EQ(served.wait_for(50ms), std::future_status::timeout);
  shutdown(listener, SHUT_RDWR);
  ASSERT_EQ(served.wait_for(10s), std::future_status::ready);
  EXPECT_THROW(served.get(), std::runtime_error);
}

TEST(HttpServer, StopsTwice) {
  const auto server = bound_server();
  const std::future<void> served = serve(server);
  server->stop();
  server->stop();
  EXPECT_EQ(served.wait_for(10s), std::future_status::ready);
}

}  // namespace
}  // namespace toile
