// Runs a fuzz target without a fuzzer: over the files of a corpus, and over
// random inputs until enough queries are answered.
//
//   pair_fuzz [--queries N] [--seed S] [--save DIR] [--tell] [FILE or DIR]...
//
// Exits with status 1 where a promise was broken; --save keeps random inputs
// that broke one, and --tell prints what is asked as Python, to be asked again
// there.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

#include "target.h"

namespace {

namespace fs = std::filesystem;
using drake_haptics::fuzz::RunInput;
using drake_haptics::fuzz::Tally;
using Bytes = std::vector<std::uint8_t>;

struct Options {
  long queries = 0;
  unsigned seed = 0;
  fs::path save;
  bool tell = false;
  std::vector<fs::path> files;
};

Options Parse(int argc, char** argv) {
  Options options;
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    const char* value = i + 1 < argc ? argv[i + 1] : "";
    if (argument == "--queries") {
      options.queries = std::atol(value);
    } else if (argument == "--seed") {
      options.seed = static_cast<unsigned>(std::atol(value));
    } else if (argument == "--save") {
      options.save = value;
    } else if (argument == "--tell") {
      options.tell = true;
      continue;
    } else if (fs::is_directory(argument)) {
      for (const auto& entry : fs::directory_iterator(argument)) {
        options.files.push_back(entry.path());
      }
      continue;
    } else {
      options.files.emplace_back(argument);
      continue;
    }
    ++i;
  }
  std::sort(options.files.begin(), options.files.end());
  return options;
}

Bytes Read(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) {
    std::fprintf(stderr, "cannot read %s\n", path.c_str());
    std::exit(2);
  }
  return {std::istreambuf_iterator<char>(file), {}};
}

Bytes Draw(std::mt19937_64* random) {
  Bytes bytes(8 + (*random)() % 600);
  for (std::uint8_t& byte : bytes) {
    byte = static_cast<std::uint8_t>((*random)());
  }
  return bytes;
}

// Runs one input; where it breaks a promise for the first few times, says so.
void RunAndTell(const Bytes& bytes, const std::string& name,
                const fs::path& save, Tally* tally) {
  constexpr int kTold = 20;
  static int told = 0;
  tally->last_violation.clear();
  RunInput(bytes, tally);
  if (tally->last_violation.empty() || told == kTold) return;
  ++told;
  std::printf("%s: %s\n", name.c_str(), tally->last_violation.c_str());
  if (save.empty()) return;
  fs::create_directories(save);
  std::ofstream(save / name, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()),
             static_cast<std::streamsize>(bytes.size()));
}

}  // namespace

int main(int argc, char** argv) {
  const Options options = Parse(argc, argv);
  Tally tally;
  tally.tells_inputs = options.tell;
  for (const fs::path& path : options.files) {
    RunAndTell(Read(path), path.filename().string(), {}, &tally);
  }
  std::mt19937_64 random(options.seed);
  const auto start = std::chrono::steady_clock::now();
  for (long i = 0; tally.queries < options.queries; ++i) {
    const std::string name =
        "seed" + std::to_string(options.seed) + "_" + std::to_string(i);
    RunAndTell(Draw(&random), name, options.save, &tally);
  }
  const std::chrono::duration<double> elapsed =
      std::chrono::steady_clock::now() - start;
  std::printf(
      "%lld queries (%lld apart, %lld overlapping), %lld refused "
      "inputs, %lld met a bound, at most %zu hubs, %.1f s\n",
      static_cast<long long>(tally.queries),
      static_cast<long long>(tally.apart),
      static_cast<long long>(tally.overlapping),
      static_cast<long long>(tally.refusals),
      static_cast<long long>(tally.bounded), tally.most_hubs, elapsed.count());
  if (tally.landings > 0) {
    std::printf(
        "%lld landings of solids in several pieces, %lld not met, %lld not met "
        "at first\n",
        static_cast<long long>(tally.landings),
        static_cast<long long>(tally.unmet),
        static_cast<long long>(tally.unmet_at_first));
  }
  for (const auto& [promise, count] : tally.violations) {
    std::printf("BROKEN %s: %lld times\n", promise.c_str(),
                static_cast<long long>(count));
  }
  return tally.is_clean() ? 0 : 1;
}
