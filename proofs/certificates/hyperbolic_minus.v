(* kickdrift verdict --lambda1 10 --lambda2 2/5 --h1 9/20 --h2 261/100 --certificate hyperbolic_minus.v *)
From Coq Require Import Reals QArith.
From Kickdrift Require Import Vocabulary Certificate.

(** kind, p, q with h2/h1 = p/q, then h1, lambda1, h2, lambda2. *)
Theorem kickdrift_verdict :
  verdict (Hyperbolic Minus) 29 5 (9 / 20) (10 / 1) (261 / 100) (2 / 5).
Proof. certify (9 # 20) (10 # 1) (261 # 100) (2 # 5). Qed.
Print Assumptions kickdrift_verdict.
