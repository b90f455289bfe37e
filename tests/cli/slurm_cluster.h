#pragma once

// A cluster of one node, of Debian's packages slurm-wlm and munge, in a folder of its own.

#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>

#include "tests/study/simulated_recording.h"

namespace imunoise::testing {

class SlurmCluster {
 public:
  SlurmCluster() {
    for (const char* const program : {"munged", "slurmctld", "slurmd", "sbatch"}) {
      if (shell(std::string("command -v ") + program)) continue;
      trouble_ = std::string(program) + " is not installed (packages slurm-wlm and munge)";
      return;
    }
    if (::geteuid() != 0) {
      trouble_ = "slurmd runs as root only";
      return;
    }
    configure();
    start();
  }
  ~SlurmCluster() {
    for (const char* const daemon : {"slurmd", "slurmctld", "munged"}) {
      std::ifstream file(path(std::string(daemon) + ".pid"));
      if (pid_t pid = 0; file >> pid) {
        ::kill(pid, SIGTERM);
        while (::kill(pid, 0) == 0) std::this_thread::sleep_for(std::chrono::milliseconds(20));
      }
    }
  }
  SlurmCluster(const SlurmCluster&) = delete;
  SlurmCluster& operator=(const SlurmCluster&) = delete;

  /// Why there is none; empty when it runs. Its programs find it by SLURM_CONF.
  const std::string& trouble() const { return trouble_; }

  /// The node is lost with all that runs on it, and comes back.
  bool lose_node() const {
    return shell("scontrol update nodename=$(hostname -s) state=down reason=test") &&
           (shell("scontrol update nodename=$(hostname -s) state=resume") ||
            shell("timeout 60 sh -c 'until sinfo -h -o %t | grep -qE \"idle|mix|alloc\"; do sleep "
                  "0.2; done'"));
  }

 private:
  std::string path(const std::string& name) const { return (folder_.path() / name).string(); }
  static bool shell(const std::string& command) {
    return std::system((command + " >/dev/null 2>&1").c_str()) == 0;
  }
  void configure() const {
    const int port = 20000 + ::getpid() % 20000;
    std::ofstream out(path("slurm.conf"));
    std::string host(256, '\0');
    ::gethostname(host.data(), host.size() - 1);
    host.resize(host.find_first_of(std::string(".\0", 2)));
    // A task that lost its node waits until its credential has expired: two minutes by default.
    out << "ClusterName=imunoise\nSlurmctldHost=" << host << "(127.0.0.1)\nSlurmUser=root\n"
        << "AuthType=auth/munge\nAuthInfo=socket=" << path("munge.socket") << ",cred_expire=5\n"
        << "SlurmctldPort=" << port << "\nSlurmdPort=" << port + 1
        << "\nStateSaveLocation=" << path("state") << "\nSlurmdSpoolDir=" << path("spool")
        << "\nSlurmctldPidFile=" << path("slurmctld.pid")
        << "\nSlurmdPidFile=" << path("slurmd.pid")
        << "\nSlurmctldLogFile=" << path("slurmctld.log")
        << "\nSlurmdLogFile=" << path("slurmd.log")
        << "\nProctrackType=proctrack/linuxproc\nTaskPlugin=task/none\n"
        << "JobAcctGatherType=jobacct_gather/none\nSelectType=select/cons_tres\n"
        << "SelectTypeParameters=CR_Core\nMpiDefault=none\nReturnToService=2\n"
        << "NodeName=" << host << " NodeAddr=127.0.0.1 CPUs=2 State=UNKNOWN\n"
        << "PartitionName=all Nodes=ALL Default=YES State=UP\n";
    ::setenv("SLURM_CONF", path("slurm.conf").c_str(), 1);
  }
  void start() {
    const std::string munge =
        "cd '" + folder_.path().string() +
        "' && mkdir -p state spool && head -c 1024 /dev/urandom > key && chmod 600 key && chmod "
        "755 "
        ". && munged --key-file=$PWD/key --socket=$PWD/munge.socket --pid-file=$PWD/munged.pid "
        "--log-file=$PWD/munged.log --seed-file=$PWD/seed";
    if (!shell(munge))
      trouble_ = "munged does not start";
    else if (!shell("slurmctld"))
      trouble_ = "slurmctld does not start";
    else if (!shell("slurmd -N $(hostname -s)"))
      trouble_ = "slurmd does not start";
    else if (!shell("timeout 60 sh -c 'until sinfo -h -o %t | grep -q idle; do sleep 0.2; done'"))
      trouble_ = "the node does not become idle";
  }

  TemporaryFolder folder_;
  std::string trouble_;
};

}  // namespace imunoise::testing
