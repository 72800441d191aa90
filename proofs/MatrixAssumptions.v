(** What the theorems of MatrixSigns.v and ImplicitExplicitModes.v say and rest on; this output is kept in MatrixAssumptions.golden. *)

Set Warnings "-notation-overridden,-ambiguous-paths".
From mathcomp Require Import all_ssreflect all_algebra.
From Kickdrift Require MatrixSigns ImplicitExplicitModes.
Set Printing Width 110.

Check MatrixSigns.both_definite. Print Assumptions MatrixSigns.both_definite.
Check MatrixSigns.both_negative. Print Assumptions MatrixSigns.both_negative.
Check MatrixSigns.one_definite. Print Assumptions MatrixSigns.one_definite.
Check ImplicitExplicitModes.twice. Print Assumptions ImplicitExplicitModes.twice.
Check ImplicitExplicitModes.stable. Print Assumptions ImplicitExplicitModes.stable.
Check ImplicitExplicitModes.unstable. Print Assumptions ImplicitExplicitModes.unstable.
Check ImplicitExplicitModes.unstable_total. Print Assumptions ImplicitExplicitModes.unstable_total.
Check ImplicitExplicitModes.edge. Print Assumptions ImplicitExplicitModes.edge.
Check ImplicitExplicitModes.edge_total. Print Assumptions ImplicitExplicitModes.edge_total.
