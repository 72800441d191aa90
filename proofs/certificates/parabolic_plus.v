(* kickdrift verdict --lambda1 3 --lambda2 1/5 --h1 1 --h2 3 --certificate parabolic_plus.v *)
From Coq Require Import Reals QArith.
From Kickdrift Require Import Vocabulary Certificate.

(** kind, p, q with h2/h1 = p/q, then h1, lambda1, h2, lambda2. *)
Theorem kickdrift_verdict :
  verdict (Parabolic Plus) 3 1 (1 / 1) (3 / 1) (3 / 1) (1 / 5).
Proof. certify (1 # 1) (3 # 1) (3 # 1) (1 # 5). Qed.
Print Assumptions kickdrift_verdict.
