(* kickdrift verdict --lambda1 10 --lambda2 2/5 --h1 1/2 --h2 17/5 --certificate hyperbolic_plus.v *)
From Coq Require Import Reals QArith.
From Kickdrift Require Import Vocabulary Certificate.

(** kind, p, q with h2/h1 = p/q, then h1, lambda1, h2, lambda2. *)
Theorem kickdrift_verdict :
  verdict (Hyperbolic Plus) 34 5 (1 / 2) (10 / 1) (17 / 5) (2 / 5).
Proof. certify (1 # 2) (10 # 1) (17 # 5) (2 # 5). Qed.
Print Assumptions kickdrift_verdict.
