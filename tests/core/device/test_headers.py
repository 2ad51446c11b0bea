"""The C headers of the device protocol: plain C99, C++20, and whole under any flags."""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest
from c_compiler import C_COMPILERS, CXX_COMPILERS, compile_c, require_c_compiler

import drake_haptics

HEADERS = ["wire.h", "limits.h", "gate.h"]
# Sends itself a wrench that is not a number, and prints the verdict and the fault.
REFUSE_NAN = """
#include <drake_haptics/gate.h>
#include <stdio.h>
int main(void) {
  const dh_gate_limits limits = dh_gate_default_limits(8.5, 0.188);
  const uint64_t bits = UINT64_C(0x7ff8000000000000);
  uint8_t bytes[DH_COMMAND_SIZE];
  dh_command command;
  dh_gate gate;
  dh_gate_init(&gate, &limits);
  memset(&command, 0, sizeof command);
  command.session = 1;
  dh_pack_command(&command, bytes);
  dh_gate_receive(&gate, 0, bytes, sizeof bytes);
  command.sequence = 1;
  command.enable = 1;
  memcpy(&command.F_Ho_B[4], &bits, sizeof bits);
  dh_pack_command(&command, bytes);
  printf("%d ", (int)dh_gate_receive(&gate, 0, bytes, sizeof bytes));
  printf("%d %d\\n", (int)gate.state, (int)gate.fault);
  return 0;
}
"""


def test_the_headers_are_in_the_folder_that_the_package_names() -> None:
    folder = Path(drake_haptics.get_include()) / "drake_haptics"
    assert sorted(path.name for path in folder.iterdir()) == sorted(HEADERS)


@pytest.mark.parametrize(
    ("compiler", "standard", "suffix"),
    [(path, "-std=c99", ".c") for path in C_COMPILERS]
    + [(path, "-std=c++20", ".cc") for path in CXX_COMPILERS]
    or [pytest.param("", "", "", marks=pytest.mark.skip(reason="no C compiler"))],
)
def test_each_header_compiles_alone_and_in_two_files(
    compiler: str, standard: str, suffix: str, tmp_path: Path
) -> None:
    for header in HEADERS:
        one, two = tmp_path / f"one{suffix}", tmp_path / f"two{suffix}"
        one.write_text(
            f"#include <drake_haptics/{header}>\nint main(void) {{ return 0; }}\n"
        )
        two.write_text(
            "#include <drake_haptics/gate.h>\n"
            "dh_gate a_gate(void);\n"
            "dh_gate a_gate(void) {\n"
            "  const dh_gate_limits limits = dh_gate_default_limits(1, 1);\n"
            "  dh_gate gate;\n"
            "  dh_gate_init(&gate, &limits);\n"
            "  return gate;\n"
            "}\n"
        )
        flags = [standard, "-O2"]
        program = compile_c(compiler, one, two, to=tmp_path / "program", flags=flags)
        subprocess.run([program], check=True, timeout=120)


@pytest.mark.parametrize("flags", [["-O0"], ["-O3", "-ffast-math"]])
def test_nan_is_refused_even_where_a_compiler_ignores_nan(
    flags: list[str], tmp_path: Path
) -> None:
    source = tmp_path / "refuse_nan.c"
    source.write_text(REFUSE_NAN)
    program = compile_c(
        require_c_compiler(),
        source,
        to=tmp_path / "program",
        flags=["-std=c99", *flags],
    )
    said = subprocess.run([program], check=True, timeout=120, capture_output=True)
    assert said.stdout.split() == [b"12", b"2", b"2"]  # not finite: fault, not finite
