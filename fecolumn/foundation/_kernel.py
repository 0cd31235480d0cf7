"""Compilation of a call tree as one piece, where numba compiles every function of it again with
everything it calls.

numba optimises each compiled function together with all its callees and emits machine code for it,
at every level of the call tree: the contact solver five times over. Here a function that is called
by compiled code is only translated; optimisation and code are left to the function that Python
calls (see numba's pull request 9566). A fourth of the time, the same digits.

In one piece LLVM also sees which references to arrays need no counting: those of
`_borrowed.borrowed`, which have no owner. numba calls its counting functions and removes needless
calls in a pass of its own. Here the counting functions are inlined. LLVM then removes every count
of a reference without an owner, and the arguments that only handed such references on. A step of a
rocking column takes a third of the time.

This reaches into numba's internals, as they are in the versions TESTED. With any other version
functions are compiled as numba does.
"""

from __future__ import annotations

import contextlib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numba
from llvmlite import binding as llvm
from numba import _dynfunc, types
from numba.core.codegen import JITCodeLibrary, JITCPUCodegen
from numba.core.cpu import CPUContext
from numba.core.environment import lookup_environment
from numba.core.registry import CPUDispatcher
from numba.core.runtime import rtsys

from fecolumn.foundation.lock import alone

# Versions of numba, first and first beyond, whose internals are as this file takes them
TESTED = (0, 59), (0, 69)

_ENVIRONMENT = "_ZN08NumbaEnv"  # how numba's names of environments begin
_entries: list = []  # functions called from Python that are being compiled now: one


def is_kept(function: Any) -> bool:
    """Whether a compiled form of a function is on disk."""
    return any(Path(function.stats.cache_path).glob(f"*.{function.__name__}-*.nbi"))


def is_tested() -> bool:
    """Whether the installed numba is one of TESTED."""
    return TESTED[0] <= tuple(int(part) for part in numba.__version__.split(".")[:2]) < TESTED[1]


class _Library(JITCodeLibrary):
    """Code of one function, left as translated until a function called from Python takes it in."""

    _translated = None

    def add_linking_library(self, library: _Library) -> None:
        if isinstance(library, _Library) and not library._finalized:
            self._linking_libraries.append(library)
        else:
            super().add_linking_library(library)

    def finalize(self) -> None:
        self._raise_if_finalized()
        own = {
            function.name
            for function in self._final_module.functions
            if not function.is_declaration
        }
        for library in self._callees():
            self._reload_init.update(library._reload_init)
            if library is rtsys.library:
                code = _counting()
            else:
                left = isinstance(library, _Library) and not library._finalized
                code = library._for_entry() if left else library._get_module_for_linking()
            self._final_module.link_in(code, preserve=True)
        for function in self._final_module.functions:
            if not function.is_declaration and function.name not in own:
                # nobody else calls it, so that what all its calls agree on is known in it
                function.linkage = "internal"
        self._optimize_final_module()
        self._final_module.verify()
        self._finalize_final_module()
        for variable in self._final_module.global_variables:
            if variable.name.startswith(_ENVIRONMENT) and (
                environment := lookup_environment(variable.name)
            ):
                self.codegen.set_env(variable.name, environment)

    def _callees(self) -> list:
        """Libraries of all functions called from here, directly or not, each once."""
        found: dict = {}
        waiting = list(self._linking_libraries)
        while waiting:
            library = waiting.pop(0)
            if library not in found:
                found[library] = None
                if isinstance(library, _Library) and not library._finalized:
                    waiting += library._linking_libraries
        return list(found)

    def _for_entry(self) -> Any:
        """The translated code, such that several entries may take it in and drop what they do not
        use.
        """
        if self._translated is None:
            self._translated = self._final_module.clone()
            for function in self._translated.functions:
                if not function.is_declaration and function.linkage.name == "external":
                    function.linkage = "linkonce_odr"
        return self._translated


def _counting() -> Any:
    """Numba's code that counts references to arrays, to be put in place of each call."""
    return llvm.parse_assembly(
        str(rtsys.library._get_module_for_linking()).replace("noinline", "alwaysinline")
    )


def _executable(
    context: Any, library: _Library, fndesc: Any, env: Any, emitted: Any = CPUContext.get_executable
) -> Any:
    """As CPUContext.get_executable; a function below the entry gets no address: only compiled code
    calls it.
    """
    entry = _entries[-1]
    if (fndesc.modname, fndesc.qualname) == (
        entry.__module__,
        entry.__qualname__,
    ) or library._finalized:
        return emitted(context, library, fndesc, env)
    return _dynfunc.make_function(
        fndesc.lookup_module(),
        fndesc.qualname.split(".")[-1],
        f"translated {fndesc.qualname}",
        0,
        env,
        (library,),
    )


@contextlib.contextmanager
def _one_piece(entry: Any) -> Iterator[None]:
    """Everything compiled in here is left to `entry`, the function called from Python."""
    if _entries:  # within another: that one is the entry
        yield
        return
    before = JITCPUCodegen._library_class, CPUContext.get_executable
    _entries.append(entry)
    JITCPUCodegen._library_class, CPUContext.get_executable = _Library, _executable
    try:
        yield
    finally:
        _entries.pop()
        JITCPUCodegen._library_class, CPUContext.get_executable = before


class Kernel(CPUDispatcher):
    """A compiled function: an entry where Python calls it, a part of the caller where compiled code
    does.
    """

    def __init__(self, py_func: Any, **options: dict[str, bool | set[str] | str]) -> None:
        super().__init__(py_func, **options)
        wrappers = dict(no_cpython_wrapper=True, no_cfunc_wrapper=True)
        self._part = CPUDispatcher(
            py_func, **(options | dict(targetoptions=options.get("targetoptions", {}) | wrappers))
        )

    def compile(self, sig: tuple[Any, ...]) -> Any:
        with contextlib.ExitStack() as stack:
            # one process of this machine compiles; others wait and open what it made
            if not self._keeps(sig):
                stack.enter_context(alone(Path(self.stats.cache_path) / self.__name__))
            stack.enter_context(_one_piece(self.py_func))
            return super().compile(sig)

    def _keeps(self, sig: tuple[Any, ...]) -> bool:
        """Whether the form for these types is on disk.

        It is not enough that some form is: two processes that each add one at once would give both
        the same number, and the form of one would be run for the types of the other.
        """
        return (
            self._cache._index_key(sig, self.targetctx.codegen())
            in self._cache._cache_file._load_index()
        )

    def get_call_template(
        self, args: tuple[Any, ...], kws: dict[Any, Any]
    ) -> tuple[Any, Any, tuple[Any, ...], dict[Any, Any]]:
        # numba would compile a function again for each constant that it is called with
        return self._part.get_call_template(
            tuple(types.unliteral(one) for one in args),
            {name: types.unliteral(one) for name, one in kws.items()},
        )

    def get_overload(self, sig: tuple[Any, ...]) -> Any:
        return self._part.get_overload(sig)
