/* Tells callgrind from Python which part to count, and to write down what it
 * has counted so far; nothing outside valgrind. */
#include <valgrind/callgrind.h>

void start(void) { CALLGRIND_START_INSTRUMENTATION; }

void toggle(void) { CALLGRIND_TOGGLE_COLLECT; }

void dump(const char* name) { CALLGRIND_DUMP_STATS_AT(name); }
