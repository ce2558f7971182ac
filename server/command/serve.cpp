#include "server/command/commands.h"
#include "server/http/http_server.h"
#include "server/http/service.h"
#include "server/store/sqlite_store.h"

#include <signal.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <memory>
#include <thread>

namespace toile {
namespace {

constexpr int kHealthThreads = 2;
constexpr std::uint64_t kRunFileLimit = std::uint64_t{1} << 30;  // bytes of one file that a run writes

/// SIGTERM and SIGINT, held back from every thread and waited for by one: no handler runs in the middle of anything.
class StopSignals {
 public:
  StopSignals() {
    sigemptyset(&set_);
    sigaddset(&set_, SIGTERM);
    sigaddset(&set_, SIGINT);
    pthread_sigmask(SIG_BLOCK, &set_, nullptr);
    signal(SIGPIPE, SIG_IGN);
  }
  int wait() const {
    int received = 0;
    sigwait(&set_, &received);
    return received;
  }

 private:
  sigset_t set_{};
};

/// A server on its own thread. One that can't go on sends the process the signal that ends it in order.
class RunningServer {
 public:
  RunningServer(Router router, HttpServerOptions options, const std::string& host, int port)
      : server_(std::move(router), options), port_(server_.bind(host, port)), thread_([this] { serve(); }) {}
  RunningServer(const RunningServer&) = delete;
  RunningServer& operator=(const RunningServer&) = delete;
  ~RunningServer() { stop(); }
  int port() const { return port_; }
  void stop() {
    server_.stop();
    if (thread_.joinable()) thread_.join();
  }
  /// After stop(): throws what ended the serving, if it was not stop().
  void rethrow_failure() const {
    if (failure_) std::rethrow_exception(failure_);
  }

 private:
  void serve() {
    try {
      server_.serve();
    } catch (...) {
      failure_ = std::current_exception();
      kill(getpid(), SIGTERM);
    }
  }

  HttpServer server_;
  int port_;
  std::exception_ptr failure_;
  std::thread thread_;
};

DispatcherOptions dispatcher_options(const ServeArguments& arguments) {
  const int cores = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  DispatcherOptions options;
  options.runner =
      arguments.runner.empty() ? std::filesystem::read_symlink("/proc/self/exe").string() : arguments.runner;
  options.runs = std::filesystem::path(arguments.data) / "runs";
  options.workers = arguments.workers > 0 ? arguments.workers : std::max(1, cores / 4);
  options.threads_per_run = std::max(1, cores / options.workers);
  options.wall_limit = std::chrono::seconds(arguments.run_limit_s);
  options.limits.address_space_bytes = static_cast<std::uint64_t>(std::max(0, arguments.run_memory_mib)) << 20;
  options.limits.cpu_s = static_cast<std::uint64_t>(arguments.run_limit_s) * static_cast<unsigned>(cores);
  options.limits.file_bytes = kRunFileLimit;
  return options;
}

}  // namespace

int run_serve(const ServeArguments& arguments) {
  const StopSignals signals;  // before any thread is made, so that all of them inherit the mask
  spdlog::set_default_logger(spdlog::stderr_color_mt("toile"));

  std::filesystem::create_directories(arguments.data);
  const std::unique_ptr<Store> store = open_sqlite_store(arguments.data);
  const DispatcherOptions options = dispatcher_options(arguments);
  Dispatcher dispatcher(*store, system_time_ms, options);
  PreviewOptions preview_options;
  preview_options.runner = options.runner;
  preview_options.folder = std::filesystem::path(arguments.data) / "previews";
  preview_options.limits = options.limits;
  std::filesystem::remove_all(preview_options.folder);
  PreviewRenderer previews(*store, preview_options);
  Service service{*store, dispatcher, previews, system_time_ms, {arguments.max_queued}};

  RunningServer server(make_router(service), {}, arguments.host, arguments.port);
  std::unique_ptr<RunningServer> health;
  if (arguments.health_port >= 0) {
    HttpServerOptions few;
    few.threads = kHealthThreads;
    health = std::make_unique<RunningServer>(make_health_router(service), few, arguments.host, arguments.health_port);
  }
  std::printf("toile " TOILE_VERSION " listens on http://%s:%d\n", arguments.host.c_str(), server.port());
  if (health) std::printf("health on http://%s:%d/healthz\n", arguments.host.c_str(), health->port());
  std::fflush(stdout);
  spdlog::info("{} runs at once, {} threads each; data in {}", options.workers, options.threads_per_run,
               arguments.data);

  spdlog::info("signal {}: stopping", signals.wait());
  server.stop();
  if (health) health->stop();
  dispatcher.stop();
  server.rethrow_failure();
  if (health) health->rethrow_failure();
  return 0;
}

}  // namespace toile
