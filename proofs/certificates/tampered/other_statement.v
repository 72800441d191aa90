(* kickdrift verdict --lambda1 100 --lambda2 2/5 --h1 3/10 --h2 7/10 --certificate elliptic.v *)
From Coq Require Import Reals QArith.
From Kickdrift Require Import Vocabulary Certificate.

(** kind, p, q with h2/h1 = p/q, then h1, lambda1, h2, lambda2. *)
Theorem kickdrift_verdict :
  verdict Elliptic 7 3 (3 / 10) (100 / 1) (7 / 10) (2 / 5).
Proof. certify (3 # 10) (10 # 1) (7 # 10) (2 # 5). Qed.
Print Assumptions kickdrift_verdict.
