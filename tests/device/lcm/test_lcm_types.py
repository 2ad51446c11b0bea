"""Our LCM messages against the classes that lcm-gen writes from the .lcm files."""

import copy
import importlib.util
import math
import struct
import subprocess
from dataclasses import FrozenInstanceError, asdict
from pathlib import Path

import lcm
import pytest
from hypothesis import given
from hypothesis import strategies as st

import drake_haptics.device.lcm
from drake_haptics.device.backend import Fault, GateState
from drake_haptics.device.lcm.haptic_messages import (
    lcmt_haptic_command,
    lcmt_haptic_status,
)

TYPES = [lcmt_haptic_command, lcmt_haptic_status]
FOLDER = Path(drake_haptics.device.lcm.__file__).parent
NUMBERS = {
    "boolean": st.booleans(),
    "int8_t": st.integers(-(2**7), 2**7 - 1),
    "int32_t": st.integers(-(2**31), 2**31 - 1),
    "int64_t": st.integers(-(2**63), 2**63 - 1),
    "double": st.floats(allow_nan=False),
}


@pytest.fixture(scope="module")
def generated(tmp_path_factory):
    """The classes that lcm-gen writes, by name."""
    folder = tmp_path_factory.mktemp("lcm_gen")
    files = sorted(FOLDER.glob("*.lcm"))
    subprocess.run(
        [Path(lcm.LCM_BIN_DIR) / "lcm-gen", "--python", "--ppath", folder, *files],
        check=True,
        timeout=180,
    )
    classes = {}
    for file in files:
        spec = importlib.util.spec_from_file_location(
            file.stem, folder / "drake_haptics" / f"{file.stem}.py"
        )
        module = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(module)
        classes[file.stem] = getattr(module, file.stem)
    assert sorted(classes) == sorted(cls.__name__ for cls in TYPES)
    return classes


@pytest.mark.parametrize("cls", TYPES)
@given(data=st.data())
def test_bytes_are_those_of_lcm_gen(generated, cls, data):
    truth = generated[cls.__name__]()
    for name, lcm_type, dimensions in zip(
        truth.__slots__, truth.__typenames__, truth.__dimensions__, strict=True
    ):
        number = NUMBERS[lcm_type]
        if dimensions is not None:
            (length,) = dimensions
            number = st.lists(number, min_size=length, max_size=length).map(tuple)
        setattr(truth, name, data.draw(number))
    ours = cls(**{name: getattr(truth, name) for name in truth.__slots__})
    assert ours.encode() == truth.encode()
    assert cls.decode(truth.encode()) == ours
    decoded = type(truth).decode(ours.encode())
    assert {name: getattr(decoded, name) for name in decoded.__slots__} == asdict(ours)


def test_numbers_of_gate_and_fault_are_those_of_the_interface(generated):
    status = generated["lcmt_haptic_status"]
    assert {name: getattr(status, name) for name in dir(status) if name[0] == "k"} == {
        "k" + item.name.title().replace("_", ""): item.value
        for enum in (GateState, Fault)
        for item in enum
    }


@pytest.mark.parametrize("cls", TYPES)
def test_bytes_of_another_type_or_length_are_refused(cls):
    data = cls().encode()
    other = next(item for item in TYPES if item is not cls)
    for wrong in (b"", data[:-1], data + b"\0", other().encode()):
        with pytest.raises(ValueError, match=f"{cls.__name__}: must have"):
            cls.decode(wrong)
    with pytest.raises(ValueError, match="of another type"):
        cls.decode(bytes([data[0] ^ 1]) + data[1:])


def test_what_does_not_fit_is_not_sent():
    for wrong in ({"utime": 2**63}, {"wrench": (0.0,) * 5}, {"wrench": (0.0,) * 7}):
        with pytest.raises(struct.error):
            lcmt_haptic_command(**wrong).encode()


def test_not_a_number_crosses_as_it_is():
    """The gate refuses it; a message must not hide it."""
    sent = lcmt_haptic_command(wrench=(math.nan, math.inf, -math.inf, 0.0, 0.0, 0.0))
    got = lcmt_haptic_command.decode(sent.encode()).wrench
    assert math.isnan(got[0])
    assert got[1:] == (math.inf, -math.inf, 0.0, 0.0, 0.0)


def test_a_message_is_a_value():
    message = lcmt_haptic_status(utime=1)
    assert copy.deepcopy(message) is message
    with pytest.raises(FrozenInstanceError):
        message.utime = 2
