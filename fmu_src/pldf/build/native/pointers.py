"""What the compiled entry points need to get from C pointers to the kernel's arguments.

C owns one record and one block of float64 columns. These intrinsics only give them a type: nothing
is allocated or counted, so numba's runtime is not needed.
"""

from __future__ import annotations

from typing import Any, Final

import numba
from numba.extending import intrinsic
from numba.np import arrayobj

types: Any = numba.types  # numba's own annotations are incomplete
arrays_of: Any = arrayobj
VECTOR: Final = types.Array(types.float64, 1, "C")


def _record_at(_: Any, pointer: Any) -> Any:

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        return arguments[0]  # a record is handed around as a pointer

    return pointer.dtype(pointer), generate


def _columns(_: Any, kind: Any, block: Any, first: Any, length: Any) -> Any:
    tuple_type = types.NamedUniTuple(VECTOR, len(kind.instance_class._fields), kind.instance_class)

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        _, base, start, count = arguments
        arrays = []
        size = context.get_constant(types.intp, 8)
        for k in range(tuple_type.count):
            at = builder.add(start, builder.mul(count, count.type(k)))
            array = arrays_of.make_array(VECTOR)(context, builder)
            data = builder.gep(base, [at])
            arrays_of.populate_array(array, data, (count,), (size,), size, None)
            arrays.append(array._getvalue())
        return context.make_tuple(builder, tuple_type, arrays)

    return tuple_type(kind, block, types.int64, types.int64), generate


# record_at(pointer): the record that the pointer (to a numba record) points to.
record_at: Any = intrinsic(_record_at)
# columns(kind, block, first, length): the named tuple ``kind`` of columns of ``length`` values,
# the first of which begins ``first`` values behind the pointer ``block``.
columns: Any = intrinsic(_columns)
