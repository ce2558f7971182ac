#pragma once
// A real `toile serve` on a free loopback port, and curl to talk to it: what a person would do, done by a test.

#include <sys/types.h>

#include <chrono>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace toile {

struct CurlAnswer {
  int status = 0;  ///< 0: no answer
  std::string body;
  nlohmann::json json() const { return nlohmann::json::parse(body, nullptr, false); }
};

class ServiceProcess {
 public:
  /// Starts the server on this data folder and waits until it listens.
  explicit ServiceProcess(const std::string& data, const std::vector<std::string>& arguments = {});
  ServiceProcess(const ServiceProcess&) = delete;
  ServiceProcess& operator=(const ServiceProcess&) = delete;
  ~ServiceProcess();

  /// curl with these arguments (a shell's words) on a path of this server.
  CurlAnswer curl(const std::string& path, const std::string& arguments = {}) const;
  /// POST /v1/jobs with a scene; the job's id, or "" and a test failure.
  std::string submit(const std::string& scene) const;
  /// Polls until `state`, a final state, or the patience's end; the job's document as it is then.
  nlohmann::json wait_for(const std::string& id, const std::string& state, int patience_s = 60) const;

  void kill_now();  ///< kill -9
  int stop();       ///< SIGTERM; the exit status
  /// Shuts its listening socket down, as if the system had taken it; false where this process may not.
  bool break_listener() const;
  int wait();  ///< for its end; the exit status
  long resident_kib() const;
  pid_t pid() const { return pid_; }
  /// The runs that this server has started.
  std::vector<pid_t> runs() const;

 private:
  pid_t pid_ = -1;
  int port_ = 0;
};

/// Starts a server, a health port too, sends SIGTERM after the delay, which may be before it listens, and waits: its
/// exit status, -1 when a signal ended it, nothing when it had to be killed. The signal is blocked at the start, for
/// one that comes before the program's first line would rightly end it otherwise.
std::optional<int> status_when_stopped_after(std::chrono::milliseconds delay, const std::string& data,
                                             std::chrono::seconds patience);

/// The output of a shell command line, and its exit status.
std::string shell(const std::string& command, int* status = nullptr);

/// Whether the process is there and no zombie.
bool is_alive(pid_t pid);

}  // namespace toile
