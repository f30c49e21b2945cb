"""How kernels are compiled, and kept on the disk.

A kernel knows of this only the decorators it is defined with.  Numba's compiler compiles each kernel anew in each of its
callers; where it is known to work, most of that is left out.  Everything here that rests on Numba's internals serves that
alone, and can be done without (:func:`~carom.core.compiling.choice.compiles_plainly`).

===================  ===========================================================
``decorators``       how kernels are defined
``choice``           whether Numba compiles as it does for everybody
``cache``            the disk cache of compiled kernels
``cache_directory``  where that cache is
``names``            names in machine code, the same in every process
``intermediate``     kernels that only other kernels call
``libraries``        what is linked into a kernel, and where it is optimised
``steps``            Numba's steps of compilation, as kernels need them
``shapes``           shapes of arrays as constants of the compiler
``signatures``       types of operations, inferred once
``lowering``         the code of a kernel for LLVM, without what kernels do not need
``instructions``     complex numbers, ranges and items of arrays as instructions
``target``           the processor that kernels are compiled for
===================  ===========================================================
"""
