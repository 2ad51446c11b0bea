"""Holds the AutoDiffXd twin of a system against central differences of the system."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from pydrake.autodiffutils import ExtractGradient, ExtractValue, InitializeAutoDiff
from pydrake.systems.framework import PortDataType, System

# Weights of the sixth-order central difference.
_STENCIL = {1: 3 / 4, 2: -3 / 20, 3: 1 / 60}


def differentiate(function, x, step):
    """Returns the Jacobian of a function by central differences of sixth order."""
    x = np.asarray(x, dtype=float)
    columns = [
        sum(
            weight * (function(x + k * step * axis) - function(x - k * step * axis))
            for k, weight in _STENCIL.items()
        )
        / step
        for axis in np.eye(len(x))
    ]
    return np.column_stack(columns)


def differentiate_to_one_side(function, x, step):
    """Returns the Jacobian by differences of third order towards the step's sign."""
    x = np.asarray(x, dtype=float)
    here = function(x)
    columns = [
        (
            -11 * here
            + 18 * function(x + step * axis)
            - 9 * function(x + 2 * step * axis)
            + 2 * function(x + 3 * step * axis)
        )
        / (6 * step)
        for axis in np.eye(len(x))
    ]
    return np.column_stack(columns)


class _Side:
    """A system, or its twin, as a function of one vector."""

    def __init__(self, system: System, inputs: Mapping[str, int]):
        self._system = system
        self._context = system.CreateDefaultContext()
        self._inputs = inputs

    def __call__(self, z):
        """Returns all vector outputs, the update and the time derivatives.

        Args:
            z: Inputs, continuous state, discrete state, time.
        """
        system, context = self._system, self._context
        start = 0

        def take(size):
            nonlocal start
            start += size
            return z[start - size : start]

        for name, size in self._inputs.items():
            system.GetInputPort(name).FixValue(context, take(size))
        context.SetContinuousState(take(context.num_continuous_states()))
        for i in range(context.num_discrete_state_groups()):
            group = context.get_mutable_discrete_state(i)
            group.SetFromVector(take(group.size()))
        context.SetTime(take(1)[0])
        assert start == len(z)

        outputs = map(system.get_output_port, range(system.num_output_ports()))
        values = [
            port.Eval(context)
            for port in outputs
            if port.get_data_type() == PortDataType.kVectorValued
        ]
        values.append(system.EvalTimeDerivatives(context).CopyToVector())
        if context.num_discrete_state_groups():
            update = system.EvalUniquePeriodicDiscreteUpdate(context)
            values += [
                update.get_vector(i).CopyToVector() for i in range(update.num_groups())
            ]
        return np.concatenate(values)


def check_twin(
    system,
    inputs,
    *,
    continuous=(),
    state=(),
    constants=(),
    time_s=0.0,
    step=1e-4,
    rtol=1e-9,
    floor=1e-3,
):
    """Checks values and all derivatives of a system's twin at a point.

    Args:
        system: System that is not part of a diagram.
        inputs: Vector by name of the input.
        continuous: Continuous state of the system.
        state: Discrete state of the system, all groups.
        constants: Entries of the state that are not varied.
        time_s: Time, s.
        step: Step of the differences.
        rtol: Largest error of an entry, relative to the largest derivative of its
            row, or to the row's value.
        floor: Rows smaller than this count as if they were this large.

    Returns:
        The Jacobian, by inputs, states and time; zeros by what is not varied.
    """
    sizes = {name: len(vector) for name, vector in inputs.items()}
    z = np.concatenate([*inputs.values(), continuous, state, [time_s]])
    varied = np.ones(len(z))
    varied[len(z) - 1 - len(state) + np.asarray(constants, dtype=int)] = 0.0
    seed = np.diag(varied)
    original = _Side(system, sizes)
    found = _Side(system.ToAutoDiffXd(), sizes)(InitializeAutoDiff(z, seed).ravel())
    value = original(z)
    np.testing.assert_allclose(
        ExtractValue(found).ravel(), value, rtol=1e-12, atol=1e-12
    )
    jacobian = ExtractGradient(found)
    # What is infinite, as a limit that there is not, must be constant.
    finite = np.isfinite(value)
    assert not jacobian[~finite].any()
    expected = np.zeros(jacobian.shape)
    expected[finite] = differentiate(
        lambda x: original(z + varied * (x - z))[finite], z, step
    )
    value = np.where(finite, value, 0.0)
    scale = np.maximum(np.abs(expected).max(axis=1), np.abs(value))
    error = np.abs(jacobian - expected) / np.maximum(scale, floor)[:, None]
    assert np.isfinite(error).all()
    assert error.max() < rtol, (
        f"derivatives are off by {error.max():.1e} of their row, at (row, column)"
        f" {np.unravel_index(error.argmax(), error.shape)}"
    )
    return jacobian
