(* kickdrift verdict --lambda1 11/4 --lambda2 57/10 --h1 1 --h2 5/3 --certificate coexistence_plus.v *)
From Coq Require Import Reals QArith.
From Kickdrift Require Import Vocabulary Certificate.

(** kind, p, q with h2/h1 = p/q, then h1, lambda1, h2, lambda2. *)
Theorem kickdrift_verdict :
  verdict Elliptic 5 3 (1 / 1) (11 / 4) (5 / 3) (57 / 10).
Proof. certify (1 # 1) (11 # 4) (5 # 3) (57 # 10). Qed.
Print Assumptions kickdrift_verdict.
