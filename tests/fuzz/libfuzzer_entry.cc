// The entry of libFuzzer (and of AFL++, whose compiler knows it too).
#include <cstdio>
#include <cstdlib>

#include "target.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data,
                                      std::size_t size) {
  drake_haptics::fuzz::Tally tally;
  drake_haptics::fuzz::RunInput({data, size}, &tally);
  if (!tally.is_clean()) {
    std::fprintf(stderr, "%s\n", tally.last_violation.c_str());
    std::abort();
  }
  return 0;
}
