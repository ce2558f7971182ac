#include "tests/service/service_process.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <thread>

extern char** environ;

namespace toile {
namespace {

using namespace std::chrono_literals;

/// The words of /proc/PID/stat after the command's name, the first being the state; none of a process that has ended.
std::vector<std::string> stat_of(pid_t pid) {
  std::ifstream file("/proc/" + std::to_string(pid) + "/stat");
  std::string text;
  std::getline(file, text, '\0');  // the buffer's own iterator throws where the process ends between open and read
  std::istringstream words(text.substr(std::min(text.rfind(')') + 1, text.size())));
  std::vector<std::string> list;
  for (std::string word; words >> word;) list.push_back(word);
  return list;
}

enum class StopSignal { taken, held };

/// Starts `toile serve`; `output` becomes its standard output's reading end. `held`: SIGTERM is blocked when the
/// program begins, so that one that comes before it listens for signals waits instead of killing it.
pid_t spawn_server(const std::string& data, const std::vector<std::string>& extra, StopSignal stop, int& output) {
  std::array<int, 2> ends{};
  if (pipe(ends.data()) != 0) throw std::runtime_error("pipe");
  std::vector<std::string> arguments{TOILE_BINARY, "serve", "--port", "0", "--data", data};
  arguments.insert(arguments.end(), extra.begin(), extra.end());
  std::vector<char*> words;
  for (std::string& argument : arguments) words.push_back(argument.data());
  words.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
  posix_spawn_file_actions_addclosefrom_np(&actions, 3);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  sigset_t blocked;
  sigemptyset(&blocked);
  if (stop == StopSignal::held) sigaddset(&blocked, SIGTERM);
  posix_spawnattr_setsigmask(&attributes, &blocked);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK);
  pid_t pid = -1;
  const int error = posix_spawn(&pid, TOILE_BINARY, &actions, &attributes, words.data(), environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  close(ends[1]);
  if (error != 0) throw std::runtime_error("can't start " TOILE_BINARY);
  output = ends[0];
  return pid;
}

}  // namespace

std::string shell(const std::string& command, int* status) {
  FILE* const pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) throw std::runtime_error("popen");
  std::string output;
  std::array<char, 4096> buffer;
  for (std::size_t count; (count = fread(buffer.data(), 1, buffer.size(), pipe)) > 0;)
    output.append(buffer.data(), count);
  const int code = pclose(pipe);
  if (status != nullptr) *status = WIFEXITED(code) ? WEXITSTATUS(code) : -1;
  return output;
}

bool is_alive(pid_t pid) {
  const std::vector<std::string> stat = stat_of(pid);
  return !stat.empty() && stat[0] != "Z";
}

ServiceProcess::ServiceProcess(const std::string& data, const std::vector<std::string>& extra) {
  int end = -1;
  pid_ = spawn_server(data, extra, StopSignal::taken, end);
  FILE* const output = fdopen(end, "r");
  std::array<char, 256> line{};
  if (fgets(line.data(), line.size(), output) != nullptr) {
    const std::string text(line.data());
    port_ = std::stoi(text.substr(text.rfind(':') + 1));
  }
  fclose(output);
  if (port_ == 0) throw std::runtime_error("the server did not come up");
}

ServiceProcess::~ServiceProcess() { kill_now(); }

CurlAnswer ServiceProcess::curl(const std::string& path, const std::string& arguments) const {
  const std::string text = shell("curl --silent --max-time 30 --noproxy '*' --write-out '\\n%{http_code}' " +
                                 arguments + " 'http://127.0.0.1:" + std::to_string(port_) + path + "'");
  const std::size_t line = text.rfind('\n');
  if (line == std::string::npos) return {};
  return {std::atoi(text.c_str() + line + 1), text.substr(0, line)};
}

std::string ServiceProcess::submit(const std::string& scene) const {
  const CurlAnswer answer = curl("/v1/jobs", "--json '{\"scene\":" + scene + "}'");
  EXPECT_EQ(answer.status, 202) << answer.body;
  return answer.status == 202 ? answer.json()["id"].get<std::string>() : "";
}

nlohmann::json ServiceProcess::wait_for(const std::string& id, const std::string& state, int patience_s) const {
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(patience_s);
  for (;;) {
    nlohmann::json job = curl("/v1/jobs/" + id).json();
    const std::string now = job.is_object() ? job.value("state", "") : "";
    const bool is_over = now == "succeeded" || now == "failed" || now == "cancelled";
    if (now == state || is_over || std::chrono::steady_clock::now() > deadline) return job;
    std::this_thread::sleep_for(30ms);
  }
}

void ServiceProcess::kill_now() {
  if (pid_ < 0) return;
  kill(pid_, SIGKILL);
  waitpid(pid_, nullptr, 0);
  pid_ = -1;
}

int ServiceProcess::stop() {
  kill(pid_, SIGTERM);
  return wait();
}

bool ServiceProcess::break_listener() const {
  const int process = static_cast<int>(syscall(SYS_pidfd_open, pid_, 0));
  if (process < 0) return false;
  bool broken = false;
  for (int descriptor = 0; descriptor < 64; ++descriptor) {
    const int own = static_cast<int>(syscall(SYS_pidfd_getfd, process, descriptor, 0));
    if (own < 0) continue;
    int listens = 0;
    socklen_t size = sizeof listens;
    if (getsockopt(own, SOL_SOCKET, SO_ACCEPTCONN, &listens, &size) == 0 && listens != 0)
      broken = shutdown(own, SHUT_RDWR) == 0 || broken;
    close(own);
  }
  close(process);
  return broken;
}

int ServiceProcess::wait() {
  int status = 0;
  waitpid(pid_, &status, 0);
  pid_ = -1;
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

std::optional<int> status_when_stopped_after(std::chrono::milliseconds delay, const std::string& data,
                                             std::chrono::seconds patience) {
  int output = -1;
  const pid_t pid = spawn_server(data, {"--health-port", "0"}, StopSignal::held, output);
  std::this_thread::sleep_for(delay);
  kill(pid, SIGTERM);
  const auto deadline = std::chrono::steady_clock::now() + patience;
  int status = 0;
  pid_t ended = 0;
  while ((ended = waitpid(pid, &status, WNOHANG)) == 0 && std::chrono::steady_clock::now() < deadline)
    std::this_thread::sleep_for(2ms);
  if (ended == 0) {
    kill(pid, SIGKILL);
    waitpid(pid, nullptr, 0);
  }
  close(output);
  if (ended == 0) return std::nullopt;
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

long ServiceProcess::resident_kib() const {
  std::ifstream status("/proc/" + std::to_string(pid_) + "/status");
  for (std::string word; status >> word;) {
    long kib = 0;
    if (word == "VmRSS:" && status >> kib) return kib;
  }
  return -1;
}

std::vector<pid_t> ServiceProcess::runs() const {
  std::vector<pid_t> found;
  for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
    const pid_t pid = std::atoi(entry.path().filename().c_str());
    if (pid <= 0) continue;
    const std::vector<std::string> stat = stat_of(pid);
    if (stat.size() > 1 && stat[0] != "Z" && std::atoi(stat[1].c_str()) == pid_) found.push_back(pid);
  }
  return found;
}

}  // namespace toile
